#include <algorithm>
#include <random>
#include <ranges>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "tests/count_of.hpp"
#include "tests/runtime/st/instance.hpp"

using namespace lineshaft;

// Random sequential function charts beside an evaluator that works each scan out anew from all
// scans before it, as IEC 61131-3:2013, 6.7, tells of steps, transitions and qualifiers.
namespace {

constexpr int chart_scans = 24, actions = 5, truths = 6;
constexpr int first_counter = 3;  ///< of the actions: the others are BOOLs
constexpr std::string_view qualifiers[] = {"N", "S", "R",  "P",  "P0", "P1",
                                           "L", "D", "SD", "DS", "SL"};

struct Association {
    int action = 0;
    std::string_view qualifier;
    int time = 0;  ///< [ms], of L, D, SD, DS and SL

    bool has_time() const {
        return qualifier.ends_with('L') || qualifier.find('D') != qualifier.npos;
    }
};

struct Transition {
    std::vector<int> from, to;
    int truth = 0;    ///< that it asks for
    int longer = -1;  ///< than so many ms the first step of `from` must last; -1: no matter
    int priority = 0;
};

struct Chart {
    std::vector<std::vector<Association>> steps;
    std::vector<Transition> transitions;
    std::vector<unsigned> truths;  ///< of each scan, a bit each
};

class Drawer {
  public:
    explicit Drawer(unsigned seed) : random_(seed) {}

    Chart chart() {
        Chart made;
        made.steps.resize(static_cast<std::size_t>(2 + below(5)));
        for (auto& step : made.steps)
            for (int i = below(4); i > 0; --i) step.push_back(association());
        const int steps = static_cast<int>(made.steps.size());
        for (int i = steps + below(3); i > 0; --i) {
            Transition t{.from = some(steps), .to = some(steps), .truth = below(truths)};
            if (below(3) == 0) t.longer = below(5);
            if (below(3) == 0) t.priority = 1 + below(3);
            made.transitions.push_back(t);
        }
        for (int i = 0; i < chart_scans; ++i)
            made.truths.push_back(static_cast<unsigned>(random_() | random_()));
        return made;
    }

  private:
    int below(int end) { return static_cast<int>(random_() % static_cast<unsigned>(end)); }
    Association association() {
        Association made{.action = below(actions), .qualifier = qualifiers[below(11)]};
        if (made.has_time()) made.time = below(6);
        return made;
    }
    std::vector<int> some(int steps) {
        std::vector<int> made = {below(steps)};
        if (const int other = below(steps); below(3) == 0 && other != made[0])
            made.push_back(other);
        return made;
    }

    std::mt19937 random_;
};

std::string names(const std::vector<int>& steps) {
    std::vector<std::string> made;
    for (const int step : steps) made.push_back(fmt::format("S{}", step));
    return made.size() == 1 ? made[0] : fmt::format("({})", fmt::join(made, ", "));
}

std::string text_of(const Chart& chart) {
    std::string out = "VAR_GLOBAL";
    for (int i = 0; i < truths; ++i) out += fmt::format(" c{} : BOOL;", i);
    out += fmt::format(
        " END_VAR\nPROGRAM Driver\nVAR n : INT; t : ARRAY[0..{}] OF WORD := [{}]; END_VAR\n",
        chart_scans - 1,
        fmt::join(chart.truths | std::views::transform([](unsigned bits) { return bits & 0x3F; }),
                  ", "));
    for (int i = 0; i < truths; ++i) out += fmt::format("c{0} := t[n].%X{0};\n", i);
    out += "n := n + 1;\nEND_PROGRAM\nPROGRAM Main\nVAR";
    for (int i = 0; i < actions; ++i)
        out += fmt::format(" {}{} : {};", i < first_counter ? "a" : "n", i,
                           i < first_counter ? "BOOL" : "INT");
    out += " END_VAR\n";
    for (std::size_t i = 0; i < chart.steps.size(); ++i) {
        out += fmt::format("{}STEP S{}:\n", i == 0 ? "INITIAL_" : "", i);
        for (const Association& a : chart.steps[i])
            out += fmt::format("    a{}({}{});\n", a.action, a.qualifier,
                               a.has_time() ? fmt::format(", T#{}ms", a.time) : "");
        out += "END_STEP\n";
    }
    for (const Transition& t : chart.transitions)
        out += fmt::format(
            "TRANSITION{} FROM {} TO {} := c{}{};\nEND_TRANSITION\n",
            t.priority > 0 ? fmt::format(" (PRIORITY := {})", t.priority) : "", names(t.from),
            names(t.to), t.truth,
            t.longer >= 0 ? fmt::format(" AND S{}.T >= T#{}ms", t.from[0], t.longer) : "");
    for (int i = first_counter; i < actions; ++i)
        out += fmt::format("ACTION a{0}: n{0} := n{0} + 1; END_ACTION\n", i);
    return out + "END_PROGRAM\n";
}

/// Knows which steps were active in which scan and since when, and looks for all else there.
class Evaluator {
  public:
    explicit Evaluator(const Chart& chart) : chart_(chart) {
        for (std::size_t i = 0; i < chart.transitions.size(); ++i) order_.push_back(i);
        std::ranges::stable_sort(order_, {}, [&](std::size_t i) {
            const int priority = chart.transitions[i].priority;
            return priority == 0 ? 100 : priority;
        });
        active_.push_back(std::vector<bool>(chart.steps.size()));
        active_[0][0] = true;
        entered_.push_back(std::vector<int>(chart.steps.size(), 0));
        lasted_.resize(chart.steps.size());
    }

    /// Row 0 of the history is the chart before its first scan; a scan takes 1 ms.
    void scan() {
        const int now = static_cast<int>(active_.size()) - 1;
        auto active = active_.back();
        auto entered = entered_.back();
        for (std::size_t s = 0; s < active.size(); ++s)
            if (active[s]) lasted_[s] = now - entered[s];
        std::vector<const Transition*> fired;
        for (const std::size_t i : order_) {
            const Transition& t = chart_.transitions[i];
            const bool is_taken = std::ranges::any_of(fired, [&](const Transition* other) {
                return std::ranges::any_of(other->from, [&](int s) { return leaves(t, s); });
            });
            if (!is_taken && may_fire(t, active, now)) fired.push_back(&t);
        }
        for (const Transition* t : fired)
            for (const int s : t->from) active[index(s)] = false;
        for (const Transition* t : fired)
            for (const int s : t->to) {
                active[index(s)] = true;
                entered[index(s)] = now;
                lasted_[index(s)] = 0;
            }
        active_.push_back(active);
        entered_.push_back(entered);
        for (int a = first_counter; a < actions; ++a)
            counts_[a] += is_pulsed(a) || runs(a, last()) || (last() > 1 && runs(a, last() - 1));
    }

    bool is_active(std::size_t step) const { return active_.back()[step]; }
    int lasted(std::size_t step) const { return lasted_[step]; }
    int count(int action) const { return counts_[action]; }
    bool is_on(int action) const { return runs(action, last()) || is_pulsed(action); }

  private:
    static std::size_t index(int step) { return static_cast<std::size_t>(step); }
    int last() const { return static_cast<int>(active_.size()) - 1; }
    static bool leaves(const Transition& t, int step) {
        return std::ranges::find(t.from, step) != t.from.end();
    }
    bool may_fire(const Transition& t, const std::vector<bool>& active, int now) const {
        const bool all = std::ranges::all_of(t.from, [&](int s) { return active[index(s)]; });
        const bool long_enough = t.longer < 0 || lasted_[index(t.from[0])] >= t.longer;
        return all && long_enough && (chart_.truths[index(now)] >> t.truth & 1) != 0;
    }

    bool is_active(std::size_t step, int row) const { return active_[index(row)][step]; }
    /// In the scan before; nothing was before the first one.
    bool was_active(std::size_t step, int row) const { return row > 1 && is_active(step, row - 1); }
    /// How long a step has been active [ms].
    int time(std::size_t step, int row) const { return row - 1 - entered_[index(row)][step]; }

    template <class Condition>
    bool any(int action, Condition condition) const {
        for (std::size_t s = 0; s < chart_.steps.size(); ++s)
            for (const Association& a : chart_.steps[s])
                if (a.action == action && condition(s, a)) return true;
        return false;
    }
    bool is_reset(int action, int row) const {
        return any(action, [&](std::size_t s, const Association& a) {
            return a.qualifier == "R" && is_active(s, row);
        });
    }
    /// Since how many ms it is stored what one association asks for; -1: it is not.
    int stored(int action, std::size_t s, const Association& a, int row) const {
        int since = -1;
        for (int k = 1; k <= row; ++k) {
            const bool asks = is_active(s, k) && (a.qualifier != "DS" || time(s, k) >= a.time);
            if (since < 0 && asks) since = k;
            if (is_reset(action, k)) since = -1;
        }
        return since < 0 ? -1 : row - since;
    }
    bool asks(int action, std::size_t s, const Association& a, int row) const {
        const bool now = is_active(s, row);
        if (a.qualifier == "N") return now;
        if (a.qualifier == "P") return now && !was_active(s, row);
        if (a.qualifier == "L") return now && time(s, row) < a.time;
        if (a.qualifier == "D") return now && time(s, row) >= a.time;
        const bool stores =
            a.qualifier == "S" || a.qualifier == "DS" || a.qualifier == "SD" || a.qualifier == "SL";
        const int since = stores ? stored(action, s, a, row) : -1;
        if (a.qualifier == "SD") return since >= a.time;
        if (a.qualifier == "SL") return since >= 0 && since < a.time;
        return since >= 0;
    }
    bool runs(int action, int row) const {
        return !is_reset(action, row) && any(action, [&](std::size_t s, const Association& a) {
            return asks(action, s, a, row);
        });
    }
    bool is_pulsed(int action) const {
        return any(action, [&](std::size_t s, const Association& a) {
            const bool now = is_active(s, last()), before = was_active(s, last());
            return (a.qualifier == "P1" && now && !before) ||
                   (a.qualifier == "P0" && !now && before);
        });
    }

    const Chart& chart_;
    std::vector<std::size_t> order_;
    std::vector<std::vector<bool>> active_;
    std::vector<std::vector<int>> entered_;  ///< the scan in which a step began last
    std::vector<int> lasted_;
    int counts_[actions] = {};
};

/// What is wrong with the chart of a seed; empty if nothing.
std::string fault_of(unsigned seed) {
    const Chart chart = Drawer(seed).chart();
    const std::string text = text_of(chart);
    Diagnostics out;
    const auto library = st::compile({st::source(text)}, standard_blocks(), out);
    if (!library) return out.render() + text;
    st::Instances instances(*library);
    Evaluator evaluator(chart);
    for (int scan = 0; scan < chart_scans; ++scan) {
        instances.scan(scan * 1'000'000, 1'000'000);
        evaluator.scan();
        const auto differs = [&](const std::string& field, const std::string& wanted) {
            const std::string found = instances.text(field);
            if (found == wanted) return std::string();
            return fmt::format("scan {}: {} is {}, not {}\n{}", scan, field, found, wanted, text);
        };
        std::string wrong;
        for (std::size_t s = 0; s < chart.steps.size() && wrong.empty(); ++s) {
            wrong = differs(fmt::format("S{}.X", s), evaluator.is_active(s) ? "true" : "false");
            if (wrong.empty())
                wrong = differs(fmt::format("S{}.T", s),
                                fmt::format("{}", evaluator.lasted(s) * 1'000'000));
        }
        for (int a = 0; a < first_counter && wrong.empty(); ++a)
            wrong = differs(fmt::format("a{}", a), evaluator.is_on(a) ? "true" : "false");
        for (int a = first_counter; a < actions && wrong.empty(); ++a)
            wrong = differs(fmt::format("n{}", a), std::to_string(evaluator.count(a)));
        if (!wrong.empty()) return wrong;
    }
    return {};
}

}  // namespace

/// LINESHAFT_CHARTS makes it longer: tools/long.
TEST_CASE("charts: random ones do what an evaluator by the standard's words does", "[st]") {
    const auto last = static_cast<unsigned>(test::count_of("LINESHAFT_CHARTS", 2500));
    for (unsigned seed = 1; seed <= last; ++seed) {
        const std::string wrong = fault_of(seed);
        INFO("seed " << seed << ": " << wrong);
        REQUIRE(wrong.empty());
    }
}

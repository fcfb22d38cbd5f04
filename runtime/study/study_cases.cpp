#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/study/study_file_reader.hpp"

namespace lineshaft {

namespace {

/// No further case is checked: a grid may make many of one mistake.
constexpr std::size_t enough_mistakes = 100;

/// Whole numbers that a double holds.
constexpr double greatest_integer = 0x1p53;

struct DistributionName {
    std::string_view name;
    Distribution distribution;
};
constexpr DistributionName distributions[] = {{"uniform", Distribution::uniform},
                                              {"log_uniform", Distribution::log_uniform},
                                              {"normal", Distribution::normal},
                                              {"integer", Distribution::integer},
                                              {"choice", Distribution::choice}};

/// 3 x 1000.
std::string product_text(const CaseGroup& group) {
    std::string text;
    const auto times = [&](std::int64_t factor) {
        text += fmt::format("{}{}", text.empty() ? "" : " x ", factor);
    };
    for (const GridAxis& axis : group.grid) times(static_cast<std::int64_t>(axis.values.size()));
    if (!group.random.empty()) times(group.draws);
    if (group.repeat > 1 || text.empty()) times(group.repeat);
    return text;
}

/// The greatest number instead of a product beyond it.
std::int64_t product(std::int64_t a, std::int64_t b) {
    constexpr auto greatest = std::numeric_limits<std::int64_t>::max();
    return a > greatest / b ? greatest : a * b;
}

}  // namespace

void StudyFileReader::cases(const Node& node) {
    if (!read_.expect_sequence(node, "'cases'")) return;
    if (node.items.empty()) read_.fail("L0202", node, "'cases' has no case");
    for (const Node& item : node.items)
        if (read_.expect_map(item, "a case")) one_case(item);
}

void StudyFileReader::one_case(const Node& node) {
    read_.only_keys(node, "a case",
                    {"name", "set", "grid", "random", "draws", "seed", "compare", "repeat"});
    CaseGroup group;
    group.mark = node.mark;
    group.settings = common_;
    group.repeat = common_repeat_;
    const Node* label = node.find("name");
    if (label && read_.identifier(*label, "a case")) group.name = name(*label);
    if (const Node* n = node.find("set")) settings(*n, group.settings);
    if (const Node* n = node.find("repeat"))
        group.repeat = positive(*n, "a case runs at least once");
    std::vector<PendingComparison> compared = common_comparisons_;
    if (const Node* n = node.find("compare")) comparisons(*n, compared);
    const std::size_t before = read_.diagnostics().list().size();
    parts(node, group);
    if (label && (node.find("grid") || node.find("random")))
        read_.fail("L0213", *label,
                   "a grid or random values make many cases, which cannot share a name",
                   "leave the name out, or write the cases one by one");
    if (read_.diagnostics().list().size() > before) {
        cases_known_ = false;
        return;
    }
    if (count(node, group)) check(group, compared);
}

void StudyFileReader::parts(const Node& node, CaseGroup& group) {
    if (const Node* n = node.find("grid")) grid(*n, group);
    const Node* values = node.find("random");
    const Node* draws = node.find("draws");
    const Node* seed = node.find("seed");
    if (values) random(*values, group);
    if (draws) group.draws = positive(*draws, "each draw is a case");
    if (values && !draws)
        read_.fail("L0202", *values, "'random' says how values are drawn, but not how often",
                   "write beside it, for instance, draws: 100");
    for (const Node* n : {draws, seed})
        if (n && !values)
            read_.fail("L0202", *n, "there is no 'random' whose values could be drawn",
                       "write random: {speed: {uniform: [5 mm/s, 10 mm/s]}}");
    if (!seed) return;
    const std::int64_t value = read_.integer(*seed).value_or(1);
    if (value < 0) read_.fail("L0305", *seed, fmt::format("'{}' is below 0", seed->text));
    group.seed = static_cast<std::uint64_t>(value);
}

std::string StudyFileReader::name(const Node& node) {
    const auto [it, added] = names_.insert(node.text);
    if (!added) read_.fail("L0212", node, fmt::format("a case before has the name '{}'", *it));
    cases_known_ = cases_known_ && added;
    return *it;
}

std::int64_t StudyFileReader::positive(const Node& node, std::string_view least) const {
    const std::int64_t times = read_.integer(node).value_or(1);
    if (times >= 1) return times;
    read_.fail("L0305", node, fmt::format("'{}' is below 1: {}", node.text, least));
    return 1;
}

void StudyFileReader::settings(const Node& node, std::vector<Setting>& into) const {
    if (!read_.expect_map(node, "'set'")) return;
    for (const auto& [key, value] : node.entries) {
        if (!read_.expect_scalar(value, "a setting")) continue;
        std::erase_if(into, [&name = key.text](const Setting& s) { return s.name == name; });
        into.push_back({key.text, value.text, key.mark, value.mark});
    }
}

void StudyFileReader::grid(const Node& node, CaseGroup& group) const {
    if (!read_.expect_map(node, "'grid'")) return;
    for (const auto& [name, values] : node.entries) {
        if (!read_.expect_sequence(values, "the values of a grid")) return;
        GridAxis axis{.name = name.text, .mark = name.mark, .values = {}};
        for (const Node& value : values.items) {
            if (!read_.expect_scalar(value, "a value of a grid")) return;
            axis.values.push_back({name.text, value.text, name.mark, value.mark});
        }
        if (axis.values.empty())
            return read_.fail("L0202", values,
                              fmt::format("the grid has no value of '{}'", name.text));
        group.grid.push_back(std::move(axis));
    }
}

void StudyFileReader::random(const Node& node, CaseGroup& group) const {
    if (!read_.expect_map(node, "'random'")) return;
    for (const auto& [name, body] : node.entries) {
        if (std::ranges::find(group.grid, name.text, &GridAxis::name) != group.grid.end())
            read_.fail(
                "L0213", name,
                fmt::format("'{}' is drawn here, and a part of the grid as well", name.text));
        if (read_.expect_map(body, "a random value")) distribution(name, body, group);
    }
}

void StudyFileReader::distribution(const Node& name, const Node& body, CaseGroup& group) const {
    static constexpr const char* help = "write it as {uniform: [5 mm/s, 10 mm/s]}";
    if (body.entries.size() != 1)
        return read_.fail("L0202", body, "a random value has one distribution", help);
    const auto& [kind, values] = body.entries.front();
    const auto it = std::ranges::find(distributions, kind.text, &DistributionName::name);
    if (it == std::end(distributions)) {
        std::vector<std::string> known;
        for (const DistributionName& d : distributions) known.emplace_back(d.name);
        return read_.fail("L0306", kind, fmt::format("unknown distribution '{}'", kind.text),
                          suggest(kind.text, known));
    }
    RandomParameter parameter{.name = name.text,
                              .distribution = it->distribution,
                              .unit = {},
                              .choices = {},
                              .mark = values.mark};
    if (limits(kind, values, parameter)) group.random.push_back(std::move(parameter));
}

bool StudyFileReader::limits(const Node& kind, const Node& values,
                             RandomParameter& parameter) const {
    if (!read_.expect_sequence(values, fmt::format("'{}'", kind.text))) return false;
    if (parameter.distribution == Distribution::choice) {
        for (const Node& value : values.items)
            if (read_.expect_scalar(value, "a choice")) parameter.choices.push_back(value.text);
        if (values.items.empty()) read_.fail("L0202", values, "there is nothing to choose from");
        return !values.items.empty() && parameter.choices.size() == values.items.size();
    }
    if (values.items.size() != 2) {
        const bool normal = parameter.distribution == Distribution::normal;
        read_.fail("L0202", values, fmt::format("'{}' takes two numbers", kind.text),
                   normal ? "the mean and the standard deviation" : "the least and the greatest");
        return false;
    }
    const auto a = read_.quantity(values.items[0]);
    if (!a) return false;
    static const Unit one;
    const Node& second = values.items[1];
    const bool share = parameter.distribution == Distribution::normal && !is_plain(a->unit) &&
                       second.is_scalar() && second.text.ends_with('%');
    const auto b = read_.real(second, share ? one : a->unit);
    if (!b) return false;
    parameter.unit = a->unit;
    parameter.a = a->number;
    parameter.b = share ? *b * std::abs(parameter.a) : *b;
    return check_limits(values, parameter);
}

bool StudyFileReader::check_limits(const Node& values, const RandomParameter& p) const {
    const Node& first = values.items[0];
    const Node& second = values.items[1];
    if (p.distribution == Distribution::normal) {
        if (p.b < 0) read_.fail("L0305", second, fmt::format("'{}' is below 0", second.text));
        return p.b >= 0;
    }
    if (p.b < p.a) {
        read_.fail("L0305", second, fmt::format("'{}' is below '{}'", second.text, first.text),
                   "write the least value first");
        return false;
    }
    if (p.distribution == Distribution::log_uniform && !(p.a > 0)) {
        read_.fail("L0305", first,
                   fmt::format("'{}' is not above 0 and has no logarithm", first.text));
        return false;
    }
    if (p.distribution != Distribution::integer) return true;
    for (const auto& [node, value] : {std::pair(&first, p.a), std::pair(&second, p.b)}) {
        if (value == std::trunc(value) && std::abs(value) <= greatest_integer) continue;
        read_.fail("L0309", *node, fmt::format("'{}' is no whole number", node->text));
        return false;
    }
    return true;
}

/// How many cases, and where they stand in the study.
bool StudyFileReader::count(const Node& place, CaseGroup& group) {
    for (const GridAxis& axis : group.grid)
        group.count = product(group.count, static_cast<std::int64_t>(axis.values.size()));
    group.count = product(group.count, group.draws);
    group.first = study_.case_count();
    const std::int64_t runs = product(group.count, group.repeat);
    const std::string limit = fmt::format("a study makes at most {}", most_runs);
    if (runs > most_runs) {
        const Node* grid = place.find("grid");
        const std::string text = product_text(group);
        const bool beyond = runs == std::numeric_limits<std::int64_t>::max();
        read_.fail("L0601", grid ? *grid : place,
                   beyond ? fmt::format("this makes {} runs, which is beyond 2^63", text)
                   : text.find('x') == std::string::npos
                       ? fmt::format("this makes {} runs", runs)
                       : fmt::format("this makes {} = {} runs", text, runs),
                   limit);
    } else if (runs_ <= most_runs && runs_ + runs > most_runs) {
        read_.fail("L0601", place,
                   fmt::format("with this case the study makes {} runs", runs_ + runs), limit);
    }
    if (runs > most_runs || runs_ + runs > most_runs) {
        checkable_ = false;
        runs_ = most_runs + 1;
        return false;
    }
    runs_ += runs;
    return true;
}

bool StudyFileReader::enough() const {
    return !checkable_ || read_.diagnostics().list().size() > enough_mistakes;
}

/// Loads the program with the settings of the group's first case, which gives the units of what is
/// compared; then once with each other value, so that a mistake is known before the first run. What
/// is wrong with a combination of values only is told by its case.
void StudyFileReader::check(CaseGroup& group, const std::vector<PendingComparison>& pending) {
    if (enough()) return;
    study_.groups.push_back(std::move(group));
    CaseGroup& kept = study_.groups.back();
    const StudyCase first = study_.make_case(kept.first);
    const auto linked = load(first.settings);
    if (!linked) {
        cases_known_ = false;
        return;
    }
    for (const PendingComparison& comparison : pending) {
        auto made = compare(comparison, linked->machine, kept.repeat);
        if (!made)
            cases_known_ = false;
        else
            kept.comparisons.push_back(std::move(*made));
    }
    if (check_ == StudyCheck::values) check_values(kept, first.settings);
}

void StudyFileReader::check_values(const CaseGroup& group, const std::vector<Setting>& base) {
    for (const Setting& setting : base) checked_.emplace(setting.name, setting.value);
    for (const GridAxis& axis : group.grid)
        for (const Setting& value : axis.values) check_value(base, value);
    for (const RandomParameter& p : group.random)
        for (const std::string& value : probes(p))
            check_value(base, {p.name, value, group.mark, p.mark});
}

void StudyFileReader::check_value(std::vector<Setting> settings, const Setting& value) {
    if (enough() || !checked_.emplace(value.name, value.value).second) return;
    for (Setting& setting : settings)
        if (setting.name == value.name) setting = value;
    if (!load(settings)) cases_known_ = false;
}

/// Empty when anything was wrong.
std::optional<Linked> StudyFileReader::load(const std::vector<Setting>& settings) {
    const LoadOptions options{
        .settings = settings, .include_dirs = options_.include_dirs, .files = &files_};
    const std::size_t before = read_.diagnostics().list().size();
    const Program program = read_program(program_file_, options, read_.diagnostics());
    Linked linked = link(program, catalog_, read_.diagnostics());
    if (read_.diagnostics().list().size() > before) return {};
    return linked;
}

}  // namespace lineshaft

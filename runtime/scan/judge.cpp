#include "runtime/scan/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/model/kept_state.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

nlohmann::ordered_json number_json(const Value& value) {
    if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
    if (const auto* i = std::get_if<std::uint64_t>(&value)) return *i;
    return as_real(value);
}

using When = Expectation::When;

bool is_whole_run(const Expectation& e) {
    return e.when != When::at_end && e.when != When::at && e.from == 0 && e.until == never;
}

/// In the middle of an instant, so that some of what was due then has not run.
bool broke_off(const RunResult& result) {
    return result.outcome == Outcome::block_error || result.outcome == Outcome::overrun;
}

bool is_true(const Signal& signal) {
    return as_real(signal.value()) != 0;
}

}  // namespace

Judge::Judge(std::vector<Expectation> expectations) : expectations_(std::move(expectations)) {
    verdicts_.resize(expectations_.size());
    watches_.resize(expectations_.size());
    for (std::size_t i = 0; i < expectations_.size(); ++i) {
        const Expectation& e = expectations_[i];
        const bool is_judged_once = e.when == When::at || e.when == When::at_end;
        if (e.when == When::at || (e.when == When::always && !is_whole_run(e))) timed_.push_back(i);
        if (!is_judged_once) scanned_.push_back(i);
        verdicts_[i].ok = !is_judged_once;
    }
    std::ranges::stable_sort(timed_, {}, [this](std::size_t i) { return expectations_[i].from; });
}

void Judge::begin() {
    for (std::size_t i = 0; i < expectations_.size(); ++i) {
        const Expectation& e = expectations_[i];
        if (e.when == When::counted) watches_[i].level = is_true(e.signal);
        if (e.when == When::answered) watches_[i].level = is_true(*e.cause);
    }
}

void Judge::scanned(int task, const Scan& scan) {
    const std::int64_t now = next_ == never ? scan.time : next_;
    for (const std::size_t i : scanned_)
        if (verdicts_[i].ok) scanned(i, task, now, scan);
}

void Judge::scanned(std::size_t index, int task, std::int64_t now, const Scan& scan) {
    const Expectation& e = expectations_[index];
    Watch& watch = watches_[index];
    const bool is_own = e.signal.task == task;
    if (e.when == When::answered) {
        if (e.cause->task == task && rising_edge(is_true(*e.cause), watch.level)) {
            watch.has_risen = true;
            ++watch.edges;
        }
        if (is_own && is_true(e.signal)) watch.is_answered = true;
    } else if (is_own && e.when == When::counted) {
        count(index, scan.time);
    } else if (is_own && now >= e.from && now <= e.until) {
        judge(index, scan.time, scan.index);
    }
}

void Judge::settled(std::int64_t time, std::int64_t next) {
    constexpr int outside = -1;
    for (const std::size_t i : scanned_) {
        if (!verdicts_[i].ok) continue;
        const Expectation& e = expectations_[i];
        if (e.signal.task == outside || (e.cause && e.cause->task == outside))
            scanned(i, outside, time, {.time = time, .index = outside});
        if (e.when == When::answered) await(i, time, next);
    }
    for (; next_timed_ < timed_.size(); ++next_timed_) {
        const std::size_t i = timed_[next_timed_];
        if (expectations_[i].from >= next) break;
        if (expectations_[i].when == When::at || verdicts_[i].ok) judge(i, expectations_[i].from);
    }
    next_ = next;
}

/// The level may stand since before the cause: then that is the answer.
void Judge::await(std::size_t index, std::int64_t time, std::int64_t next) {
    const Expectation& e = expectations_[index];
    Watch& watch = watches_[index];
    if (watch.has_risen && watch.awaits == never) watch.awaits = time;
    if (watch.is_answered || is_true(e.signal)) watch.awaits = never;
    watch.has_risen = watch.is_answered = false;
    if (watch.awaits == never || later(watch.awaits, e.until) >= next) return;
    fail(index, fmt::format("{} rises at {}, {} is false until {}; expected true within {}",
                            e.cause->name, format_time(watch.awaits), e.signal.name,
                            format_time(later(watch.awaits, e.until)), e.wanted));
}

void Judge::count(std::size_t index, std::int64_t time) {
    const Expectation& e = expectations_[index];
    Watch& watch = watches_[index];
    if (!rising_edge(is_true(e.signal), watch.level)) return;
    if (compare(++watch.edges, e.high) > 0)
        fail(index, fmt::format("{} rises for the {}. time at {}; expected {}", e.signal.name,
                                watch.edges, format_time(time), e.wanted));
}

void Judge::save(StateWriter& out) const {
    for (const Verdict& verdict : verdicts_) {
        out.put(verdict.ok);
        out.put(verdict.deviation);
    }
    for (const Watch& watch : watches_)
        Watch::visit(watch, [&out](const auto& part) { out.put(part); });
    out.put(next_timed_);
    out.put(next_);
}

void Judge::restore(StateReader& in) {
    for (Verdict& verdict : verdicts_) {
        in.get(verdict.ok);
        in.get(verdict.deviation);
    }
    const std::vector<Watch> fresh = watches_;
    for (Watch& watch : watches_) Watch::visit(watch, [&in](auto& part) { in.get(part); });
    for (const Watch& watch : watches_)
        in.require(is_count(watch.edges) && watch.awaits >= 0, "what is expected");
    if (!in.ok()) watches_ = fresh;
    in.get(next_timed_, 0, timed_.size());
    in.get(next_, 0, never);
}

void Judge::fail(std::size_t index, std::string deviation) {
    verdicts_[index] = {.ok = false, .deviation = std::move(deviation)};
}

/// What is commanded as 100 may be reached as 100.00000000000001: four units in the last place of a
/// bound. A value without `within` is meant to the bit, and so is what is excluded.
static bool is_within(const Expectation& e, const Value& value) {
    if (compare(value, e.low) >= 0 && compare(value, e.high) <= 0) return true;
    const double low = as_real(e.low), high = as_real(e.high);
    if (e.signal.type != Type::real || low == high || e.when == When::excluded) return false;
    const auto room = [](double bound) {
        return std::isfinite(bound) ? 4 * std::numeric_limits<double>::epsilon() * std::abs(bound)
                                    : 0.0;
    };
    return as_real(value) >= low - room(low) && as_real(value) <= high + room(high);
}

void Judge::judge(std::size_t index, std::int64_t time, std::optional<std::int64_t> scan) {
    const Expectation& e = expectations_[index];
    const Value value = e.signal.value();
    verdicts_[index].ok = is_within(e, value) != (e.when == When::excluded);
    if (verdicts_[index].ok) return;
    std::string deviation =
        fmt::format("{} is {} at {}", e.signal.name, e.signal.describe(value), format_time(time));
    if (scan && *scan < 0 && e.signal.task >= 0)
        deviation += ", before the first scan";
    else if (scan && *scan >= 0)
        deviation += fmt::format(", scan {}", *scan);
    if (std::isnan(as_real(value))) deviation += ", and no comparison with NaN is fulfilled";
    fail(index, deviation + fmt::format("; expected {}", e.wanted));
}

/// Why it cannot be said of a run so short whether the expectation holds; empty when it can.
std::string Judge::undecided(std::size_t index, const RunResult& result) const {
    const Expectation& e = expectations_[index];
    const Watch& watch = watches_[index];
    const bool stopped = result.outcome != Outcome::completed;
    const std::int64_t judged_until = result.time - (broke_off(result) ? 1 : 0);
    const std::string ended =
        fmt::format("is undecided: the run {} at {}{}", stopped ? "stopped" : "ended",
                    format_time(result.time), stopped ? "" : "; let it run longer");
    if (e.when == When::at)
        return e.from <= judged_until
                   ? ""
                   : fmt::format("{} at {} {}", e.signal.name, format_time(e.from), ended);
    if (e.when == When::always && !is_whole_run(e))
        return e.until <= judged_until
                   ? ""
                   : fmt::format("{} until {} {}", e.signal.name, format_time(e.until), ended);
    if (e.when == When::answered && watch.awaits != never)
        return fmt::format("{} rises at {}, and whether {} follows until {} {}", e.cause->name,
                           format_time(watch.awaits), e.signal.name,
                           format_time(later(watch.awaits, e.until)), ended);
    const bool has_all_edges = e.when == When::counted && compare(watch.edges, e.low) >= 0 &&
                               as_real(e.high) == std::numeric_limits<double>::infinity();
    return stopped && !has_all_edges ? e.signal.name + " " + ended : "";
}

void Judge::finish(const RunResult& result) {
    for (std::size_t i = 0; i < expectations_.size(); ++i) {
        Verdict& verdict = verdicts_[i];
        if (!verdict.deviation.empty()) continue;
        std::string why = undecided(i, result);
        if (why.empty())
            conclude(i, result);
        else
            verdict = {.ok = false, .undecided = true, .deviation = std::move(why)};
    }
}

/// What only the whole run decides.
void Judge::conclude(std::size_t index, const RunResult& result) {
    const Expectation& e = expectations_[index];
    const std::int64_t edges = watches_[index].edges;
    if (e.when == When::at_end)
        judge(index, result.time,
              e.signal.task < 0 ? std::optional<std::int64_t>{}
                                : result.scans[static_cast<std::size_t>(e.signal.task)] - 1);
    if (e.when == When::counted && compare(edges, e.low) < 0)
        fail(index, fmt::format("{} rises {} times until the end at {}; expected {}", e.signal.name,
                                edges, format_time(result.time), e.wanted));
    if (e.when == When::answered && edges == 0)
        fail(index, fmt::format("{} never rises, so that {} is never awaited", e.cause->name,
                                e.signal.name));
}

bool Judge::ok() const {
    return std::ranges::all_of(verdicts_, &Verdict::ok);
}

nlohmann::ordered_json verdicts_json(const Judge& judge) {
    auto list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < judge.expectations().size(); ++i) {
        const Expectation& e = judge.expectations()[i];
        const Verdict& verdict = judge.verdicts()[i];
        const bool is_always = e.when == When::always && is_whole_run(e);
        nlohmann::ordered_json object{
            {"text", e.text}, {"signal", e.signal.name}, {"always", is_always}, {"ok", verdict.ok}};
        if (e.when == When::at) object["at"] = seconds(e.from);
        const bool is_drawn = is_always || e.when == When::at || e.when == When::at_end;
        if (is_drawn && std::isfinite(as_real(e.low))) object["low"] = number_json(e.low);
        if (is_drawn && std::isfinite(as_real(e.high))) object["high"] = number_json(e.high);
        if (verdict.undecided) object["undecided"] = true;
        if (!verdict.ok) object["deviation"] = verdict.deviation;
        list.push_back(std::move(object));
    }
    return list;
}

}  // namespace lineshaft

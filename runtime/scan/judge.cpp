#include "runtime/scan/judge.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

nlohmann::ordered_json number_json(const Value& value) {
    if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
    return as_real(value);
}

}  // namespace

Judge::Judge(std::vector<Expectation> expectations) : expectations_(std::move(expectations)) {
    verdicts_.resize(expectations_.size());
    for (std::size_t i = 0; i < expectations_.size(); ++i) {
        if (expectations_[i].at) timed_.push_back(i);
        if (!expectations_[i].always) continue;
        always_.push_back(i);
        verdicts_[i].ok = true;
    }
    std::ranges::stable_sort(timed_, {}, [this](std::size_t i) { return *expectations_[i].at; });
}

void Judge::scanned(int task, const Scan& scan) {
    for (const std::size_t i : always_)
        if (expectations_[i].signal.task == task && verdicts_[i].ok)
            judge(i, scan.time, scan.index);
}

void Judge::settled(std::int64_t time, std::int64_t next) {
    for (const std::size_t i : always_)
        if (expectations_[i].signal.task < 0 && verdicts_[i].ok) judge(i, time, {});
    for (; next_timed_ < timed_.size(); ++next_timed_) {
        const std::size_t i = timed_[next_timed_];
        if (*expectations_[i].at >= next) return;
        judge(i, *expectations_[i].at, {});
    }
}

void Judge::save(StateWriter& out) const {
    for (const Verdict& verdict : verdicts_) {
        out.put(verdict.ok);
        out.put(verdict.deviation);
    }
    out.put(next_timed_);
}

void Judge::restore(StateReader& in) {
    for (Verdict& verdict : verdicts_) {
        in.get(verdict.ok);
        in.get(verdict.deviation);
    }
    in.get(next_timed_);
}

void Judge::judge(std::size_t index, std::int64_t time, std::optional<std::int64_t> scan) {
    const Expectation& e = expectations_[index];
    const Value value = e.signal.value();
    Verdict& verdict = verdicts_[index];
    verdict.ok = compare(value, e.low) >= 0 && compare(value, e.high) <= 0;
    if (verdict.ok) return;
    verdict.deviation =
        fmt::format("{} is {} at {}", e.signal.name, e.signal.describe(value), format_time(time));
    if (scan && *scan < 0)
        verdict.deviation += ", before the first scan";
    else if (scan)
        verdict.deviation += fmt::format(", scan {}", *scan);
    verdict.deviation += fmt::format("; expected {}", e.wanted);
}

void Judge::finish(const RunResult& result) {
    for (; next_timed_ < timed_.size(); ++next_timed_)
        verdicts_[timed_[next_timed_]].deviation =
            fmt::format("{}: the run ended at {}, before it",
                        expectations_[timed_[next_timed_]].text, format_time(result.time));
    for (std::size_t i = 0; i < expectations_.size(); ++i) {
        const Expectation& e = expectations_[i];
        if (e.always || e.at) continue;
        judge(i, result.time,
              e.signal.task < 0 ? std::optional<std::int64_t>{}
                                : result.scans[static_cast<std::size_t>(e.signal.task)] - 1);
    }
}

bool Judge::ok() const {
    return std::ranges::all_of(verdicts_, &Verdict::ok);
}

nlohmann::ordered_json verdicts_json(const Judge& judge) {
    auto list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < judge.expectations().size(); ++i) {
        const Expectation& e = judge.expectations()[i];
        const Verdict& verdict = judge.verdicts()[i];
        nlohmann::ordered_json object{
            {"text", e.text}, {"signal", e.signal.name}, {"always", e.always}, {"ok", verdict.ok}};
        if (e.at) object["at"] = seconds(*e.at);
        if (std::isfinite(as_real(e.low))) object["low"] = number_json(e.low);
        if (std::isfinite(as_real(e.high))) object["high"] = number_json(e.high);
        if (!verdict.ok) object["deviation"] = verdict.deviation;
        list.push_back(std::move(object));
    }
    return list;
}

}  // namespace lineshaft

#include "runtime/study/report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/source/formula.hpp"

namespace lineshaft {

namespace {

constexpr std::int64_t most_shown = 200;
constexpr std::size_t most_messages = 200;

}  // namespace

bool StudyReport::ok() const {
    return failed == 0 && !interrupted && std::ranges::all_of(claims, &ClaimRow::ok);
}

void ReportBuilder::add(const CaseResult& result) {
    ++report_.cases;
    report_.machine_seconds += result.machine_seconds;
    if (!result.ok()) ++report_.failed;
    note(result);
    learn(result);
    if (!keeps(result)) {
        ++report_.left_out;
        return;
    }
    ++(shown_ < most_shown ? shown_ : shown_failed_);
    for (std::size_t k = 0; k < result.values.size(); ++k) {
        const Measured& m = result.values[k];
        report_.rows.push_back({result.of, &result.of->comparisons[k], m.ours, m.least, m.greatest,
                                result.holds(k), result.traces});
    }
}

bool ReportBuilder::keeps(const CaseResult& result) const {
    return all_rows_ || shown_ < most_shown || (!result.ok() && shown_failed_ < most_shown);
}

void ReportBuilder::note(const CaseResult& result) {
    const auto add = [&](const std::vector<std::string>& from, std::vector<std::string>& to) {
        for (const std::string& message : from)
            if (to.size() < most_messages)
                to.push_back(fmt::format("{}: {}", describe(*result.of), message));
    };
    add(result.faults, report_.faults);
    add(result.deviations, report_.deviations);
}

/// Names of a formula: each case's signals, and the errors relative to the paper over all means.
void ReportBuilder::learn(const CaseResult& result) {
    const StudyCase& of = *result.of;
    for (std::size_t k = 0; k < result.values.size(); ++k) {
        const double ours = result.values[k].ours;
        const Comparison& comparison = of.comparisons[k];
        const auto& paper = comparison.bounds.paper;
        if (comparison.statistic == Statistic::mean && paper && *paper != 0) {
            const double error = std::abs(ours - *paper) / std::abs(*paper);
            error_sum_ += error;
            greatest_error_ = std::max(greatest_error_, error);
            ++compared_;
        }
        if (of.name.empty()) continue;
        names_.emplace(of.name, ours);
        names_.emplace(of.name + "." + comparison.name(), ours);
    }
}

StudyReport ReportBuilder::finish(bool interrupted, bool is_chunk) {
    report_.interrupted = interrupted;
    if (interrupted || is_chunk) return std::move(report_);
    if (compared_ > 0) {
        names_["mean_relative_error"] = error_sum_ / static_cast<double>(compared_);
        names_["greatest_relative_error"] = greatest_error_;
    }
    for (const Claim& claim : study_.claims) {
        const auto result = evaluate(claim.formula, [&](std::string_view name) {
            const auto it = names_.find(name);
            return it == names_.end() ? std::nullopt : std::optional(it->second);
        });
        const bool known = result.error.empty() && std::isfinite(result.amount.value);
        report_.claims.push_back(
            {&claim, known ? result.amount.value : std::numeric_limits<double>::quiet_NaN(),
             known && claim.bounds.hold(result.amount.value)});
    }
    return std::move(report_);
}

StudyReport run(const Study& study, const Catalog& catalog, const StudyOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    ReportBuilder builder(study, true);
    const auto all = static_cast<std::size_t>(study.case_count());
    std::size_t done = 0;
    run_cases(study, catalog, {0, study.case_count()},
              {.jobs = options.jobs, .interrupt = options.interrupt},
              [&](const CaseResult& result) {
                  builder.add(result);
                  if (options.progress) options.progress(++done, all);
                  return true;
              });
    StudyReport report = builder.finish(options.interrupt && *options.interrupt);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    report.wall_seconds = wall.count();
    return report;
}

}  // namespace lineshaft

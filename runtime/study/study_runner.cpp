#include "runtime/study/study_runner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "runtime/study/formula.hpp"
#include "runtime/study/single_run.hpp"

namespace lineshaft {

namespace {

struct CaseResult {
    std::vector<std::vector<double>> values;  ///< per repeat, per comparison
    std::vector<std::string> faults, deviations;
    double machine_seconds = 0;
    bool done = false;
};

std::string describe(const StudyCase& c) {
    if (!c.name.empty()) return c.name;
    std::string text;
    for (const Setting& s : c.settings)
        text += fmt::format("{}{}={}", text.empty() ? "" : ", ", s.name, s.value);
    return text;
}

CaseResult run_case(const Study& study, const StudyCase& c, const Catalog& catalog,
                    const StudyOptions& options) {
    CaseResult result;
    for (std::int64_t repeat = 0; repeat < c.repeat; ++repeat) {
        Diagnostics unexpected;
        auto loaded =
            load_program(study.program, {c.settings, study.include_dirs}, catalog, unexpected);
        if (!loaded) {
            result.faults.push_back(unexpected.render());
            return result;
        }
        Machine& machine = loaded->linked.machine;
        machine.seed += static_cast<std::uint64_t>(repeat);
        const RunReport report =
            run(*loaded, {.trace_path = {}, .interrupt = options.interrupt, .progress = {}});
        if (report.faulted())
            result.faults.push_back(fmt::format("{}: {}", describe(c), report.result.message));
        if (report.result.outcome == Outcome::interrupted) return result;
        for (const Verdict& verdict : report.verdicts)
            if (!verdict.ok)
                result.deviations.push_back(fmt::format("{}: {}", describe(c), verdict.deviation));
        result.machine_seconds += seconds(report.result.time);
        std::vector<double> values;
        for (const Comparison& comparison : c.comparisons)
            values.push_back(as_real(machine.find(comparison.signal)->value()));
        result.values.push_back(std::move(values));
    }
    result.done = true;
    return result;
}

std::vector<CaseResult> run_cases(const Study& study, const Catalog& catalog,
                                  const StudyOptions& options) {
    std::vector<CaseResult> results(study.cases.size());
    std::atomic<std::size_t> next = 0;
    std::mutex progress_mutex;
    std::size_t done = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < results.size(); i = next++) {
            if (options.interrupt && *options.interrupt) return;
            results[i] = run_case(study, study.cases[i], catalog, options);
            const std::lock_guard lock(progress_mutex);
            if (options.progress) options.progress(++done, results.size());
        }
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < options.jobs; ++i) threads.emplace_back(work);
    work();
    threads.clear();
    return results;
}

StudyRow make_row(const StudyCase& c, const CaseResult& result, std::size_t index) {
    StudyRow row{.of = &c, .comparison = &c.comparisons[index]};
    row.least = std::numeric_limits<double>::infinity();
    row.greatest = -row.least;
    double sum = 0;
    for (const auto& values : result.values) {
        sum += values[index];
        row.least = std::min(row.least, values[index]);
        row.greatest = std::max(row.greatest, values[index]);
    }
    row.ours = sum / static_cast<double>(result.values.size());
    row.ok = row.comparison->bounds.hold(row.ours);
    return row;
}

/// Names of a formula: each case's signals, and the errors relative to the paper over all rows.
std::map<std::string, double, std::less<>> names_for_claims(const std::vector<StudyRow>& rows) {
    std::map<std::string, double, std::less<>> names;
    double sum = 0, greatest = 0;
    int compared = 0;
    for (const StudyRow& row : rows) {
        const auto& paper = row.comparison->bounds.paper;
        if (paper && *paper != 0) {
            const double error = std::abs(row.ours - *paper) / std::abs(*paper);
            sum += error;
            greatest = std::max(greatest, error);
            ++compared;
        }
        if (row.of->name.empty()) continue;
        names.emplace(row.of->name, row.ours);
        names.emplace(row.of->name + "." + row.comparison->signal, row.ours);
    }
    if (compared == 0) return names;
    names["mean_relative_error"] = sum / compared;
    names["greatest_relative_error"] = greatest;
    return names;
}

/// A claim over a case that did not run to its end is left out; the fault stands in the report.
void judge_claims(const Study& study, StudyReport& report) {
    const auto names = names_for_claims(report.rows);
    for (const Claim& claim : study.claims) {
        const auto result = evaluate(claim.formula, [&](std::string_view name) {
            const auto it = names.find(name);
            return it == names.end() ? std::nullopt : std::optional(it->second);
        });
        if (result.error.empty())
            report.claims.push_back({&claim, result.value, claim.bounds.hold(result.value)});
    }
}

}  // namespace

bool StudyReport::ok() const {
    return faults.empty() && deviations.empty() && !interrupted &&
           std::ranges::all_of(rows, &StudyRow::ok) && std::ranges::all_of(claims, &ClaimRow::ok);
}

StudyReport run(const Study& study, const Catalog& catalog, const StudyOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    StudyReport report;
    const auto results = run_cases(study, catalog, options);
    for (std::size_t i = 0; i < results.size(); ++i) {
        const CaseResult& result = results[i];
        report.machine_seconds += result.machine_seconds;
        report.faults.insert(report.faults.end(), result.faults.begin(), result.faults.end());
        report.deviations.insert(report.deviations.end(), result.deviations.begin(),
                                 result.deviations.end());
        if (!result.done) continue;
        for (std::size_t k = 0; k < study.cases[i].comparisons.size(); ++k)
            report.rows.push_back(make_row(study.cases[i], result, k));
    }
    report.interrupted = options.interrupt && *options.interrupt;
    if (!report.interrupted) judge_claims(study, report);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    report.wall_seconds = wall.count();
    return report;
}

}  // namespace lineshaft

#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/study/study_runner.hpp"

namespace lineshaft {

struct StudyRow {
    std::shared_ptr<const StudyCase> of;
    const Comparison* comparison = nullptr;
    double ours = 0;  ///< mean over the repeats, or their spread
    double least = 0, greatest = 0;
    bool ok = true;
    std::vector<std::string> traces = {};  ///< files of the case
};

struct ClaimRow {
    const Claim* claim = nullptr;
    double ours = 0;  ///< NaN: it cannot be reckoned, as a case of it did not run to its end
    bool ok = true;
};

/// What is told of a study. Of a large one only some cases are kept to be shown.
struct StudyReport {
    std::vector<StudyRow> rows;  ///< the first cases, and the first that do not hold
    std::vector<ClaimRow> claims;
    std::vector<std::string> faults;      ///< cases that did not run to their end, and why
    std::vector<std::string> deviations;  ///< expectations of the program that failed
    std::int64_t cases = 0;               ///< done
    std::int64_t failed = 0;              ///< of them: out of bounds, a deviation or a fault
    std::int64_t left_out = 0;            ///< of them: not in `rows`
    double machine_seconds = 0, wall_seconds = 0;
    bool interrupted = false;

    bool ok() const;
};

/// Puts a study's report together from its cases, given in order.
class ReportBuilder {
  public:
    /// All cases are kept to be shown if `all_rows`.
    ReportBuilder(const Study& study, bool all_rows) : study_(study), all_rows_(all_rows) {}

    void add(const CaseResult& result);
    /// Judges the claims, unless interrupted or, as a chunk, without the other cases.
    StudyReport finish(bool interrupted, bool is_chunk = false);

  private:
    void note(const CaseResult& result);
    void learn(const CaseResult& result);
    bool keeps(const CaseResult& result) const;

    const Study& study_;
    bool all_rows_;
    StudyReport report_;
    std::map<std::string, double, std::less<>> names_;  ///< for the claims' formulas
    double error_sum_ = 0, greatest_error_ = 0;
    std::int64_t compared_ = 0;
    std::int64_t shown_ = 0, shown_failed_ = 0;
};

struct StudyOptions {
    unsigned jobs = 1;  ///< whole runs side by side
    const std::atomic<bool>* interrupt = nullptr;
    std::function<void(std::size_t done, std::size_t all)> progress;  ///< one thread at a time
};

/// Runs every case; the result does not depend on the number of jobs.
StudyReport run(const Study& study, const Catalog& catalog, const StudyOptions& options);

}  // namespace lineshaft

#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "runtime/study/study.hpp"

namespace lineshaft {

/// What a compared signal came to at the end of a case.
struct Measured {
    double ours = 0;                 ///< mean over the repeats, or their spread
    double least = 0, greatest = 0;  ///< of the repeats; a spread itself
};

struct CaseResult {
    std::shared_ptr<const StudyCase> of;
    std::vector<Measured> values;         ///< one a comparison; empty: it did not run to its end
    std::vector<std::string> faults;      ///< why it did not
    std::string output_error;             ///< why its trace is not there: this is no result then
    std::vector<std::string> deviations;  ///< expectations of the program that failed
    /// The program's parameters in force; none: it could not be loaded.
    std::vector<std::pair<std::string, std::string>> parameters;
    std::vector<std::string> traces;  ///< files, one a repeat; none: not traced
    double machine_seconds = 0;       ///< over all repeats

    /// Within its bounds; true for a case that did not run.
    bool holds(std::size_t comparison) const;
    bool ok() const;
};

/// Part of a study's cases, from 0.
struct CaseRange {
    std::int64_t first = 0, last = 0;  ///< `last` is one past the end

    std::int64_t count() const { return last - first; }
};

/// Where the cases' traces go, see file_stem(); of a case that is repeated to `STEM.2.csv` and so
/// on. A case that fails is known by its end only: it runs once more then, traced, which gives the
/// same values.
///
/// They are with the operating system only: flush_file_system() brings all to the disk.
struct CaseTraces {
    std::string folder;  ///< empty: nothing is traced
    bool of_failed = false;
};

struct CaseOptions {
    unsigned jobs = 1;  ///< whole runs side by side
    const std::atomic<bool>* interrupt = nullptr;
    CaseTraces traces = {};
    /// Cases that need not run again, by index. They are taken out.
    std::map<std::int64_t, CaseResult>* known = nullptr;
};

/// Runs the cases of a range; `take` gets their results in order, one thread at a time, and stops
/// the study by false; of a case whose trace could not be written it gets the error. No more than a
/// few dozen results wait for an earlier one, however long that takes, so memory does not grow with
/// the number of cases. Results that still wait when the study is stopped or interrupted are left
/// in what is returned. Neither values nor order depend on the number of jobs.
std::map<std::int64_t, CaseResult> run_cases(const Study& study, const Catalog& catalog,
                                             CaseRange range, const CaseOptions& options,
                                             const std::function<bool(const CaseResult&)>& take);

}  // namespace lineshaft

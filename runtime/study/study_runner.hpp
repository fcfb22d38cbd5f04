#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "runtime/study/study.hpp"

namespace lineshaft {

struct StudyRow {
    const StudyCase* of = nullptr;
    const Comparison* comparison = nullptr;
    double ours = 0;  ///< mean over the repeats
    double least = 0, greatest = 0;
    bool ok = true;
};

struct ClaimRow {
    const Claim* claim = nullptr;
    double ours = 0;
    bool ok = true;
};

struct StudyReport {
    std::vector<StudyRow> rows;
    std::vector<ClaimRow> claims;
    std::vector<std::string> faults;      ///< cases that did not run to their end, and why
    std::vector<std::string> deviations;  ///< expectations of the program that failed
    double machine_seconds = 0, wall_seconds = 0;
    bool interrupted = false;

    bool ok() const;
};

struct StudyOptions {
    unsigned jobs = 1;  ///< whole runs side by side
    const std::atomic<bool>* interrupt = nullptr;
    std::function<void(std::size_t done, std::size_t all)> progress;  ///< one thread at a time
};

/// Runs every case; the result does not depend on the number of jobs.
StudyReport run(const Study& study, const Catalog& catalog, const StudyOptions& options);

}  // namespace lineshaft

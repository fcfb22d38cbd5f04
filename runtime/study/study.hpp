#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/study/single_run.hpp"

namespace lineshaft {

/// How near is near enough. A value holds when it is within any of the distances of the paper's
/// value and inside both limits; without any of them nothing is judged.
struct Bounds {
    std::optional<double> paper;
    std::vector<double> within;  ///< distances from `paper`, in the signal's unit
    std::optional<double> at_least, at_most;

    bool judged() const { return !within.empty() || at_least || at_most; }
    bool hold(double value) const;
};

/// One signal of one case, to be set beside the paper's figure.
struct Comparison {
    std::string signal;
    std::string unit;
    Bounds bounds;
};

/// One run, or `repeat` runs with seeds that follow each other.
struct StudyCase {
    std::string name;               ///< for claims; may be empty
    std::vector<Setting> settings;  ///< as written, what all cases have in common first
    std::vector<Comparison> comparisons;
    std::int64_t repeat = 1;
};

/// A formula over the rows' values.
struct Claim {
    std::string text;     ///< what is claimed
    std::string formula;  ///< see formula.hpp; names are `case` (its first signal) or `case.signal`
    bool percent = false;  ///< shown in percent
    Bounds bounds;
};

/// A program, its cases, and the paper's figures beside ours.
struct Study {
    std::shared_ptr<const SourceFile> file;
    std::string title;
    std::string program;  ///< path
    std::vector<std::string> notes;
    std::vector<StudyCase> cases;
    std::vector<Claim> claims;
    std::vector<std::string> include_dirs;
};

/// Greatest number of runs of one study.
constexpr std::int64_t most_runs = 1'000'000;

/// Reads and checks a study: its structure, and its program with every case's settings.
Study read_study(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out);

/// True for a file that calls itself a study, or a program.
bool is_study(const SourceFile& file);
bool is_program(const SourceFile& file);

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

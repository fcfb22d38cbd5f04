#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/program/program.hpp"

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

}  // namespace lineshaft

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/program/program.hpp"
#include "runtime/study/draw.hpp"

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

/// What of the repeats' values is compared.
enum class Statistic { mean, spread };

/// One signal of one case, to be set beside the paper's figure.
struct Comparison {
    std::string signal;
    std::string unit;
    Bounds bounds;
    Statistic statistic = Statistic::mean;

    /// As rows, columns and formulas have it: the signal, or `fit.offset.spread`.
    std::string name() const;
};

/// One run, or `repeat` runs with seeds that follow each other.
struct StudyCase {
    std::int64_t number = 1;        ///< in the study, from 1
    std::string name;               ///< for claims; may be empty
    std::vector<Setting> settings;  ///< as written, what all cases have in common first
    std::vector<Comparison> comparisons;
    std::int64_t repeat = 1;
};

/// `early_20_5`, or `method=early, radius=20 mm`.
std::string describe(const StudyCase& c);

/// A file's name without its extension: `early_20_5`, or `0017_method=early_radius=20_mm` with as
/// many digits as the greatest number of `cases` has.
std::string file_stem(const StudyCase& c, std::int64_t cases);

/// A parameter of a grid and its values.
struct GridAxis {
    std::string name;
    Mark mark;
    std::vector<Setting> values;  ///< all of this name
};

/// One item of a study's `cases:`. Every combination of the grid's values, the last axis fastest,
/// each with all draws, which are the same ones for every combination.
struct CaseGroup {
    Mark mark;
    std::string name;               ///< of its only case; may be empty
    std::vector<Setting> settings;  ///< as written, what all cases have in common first
    std::vector<GridAxis> grid;
    std::vector<RandomParameter> random;
    std::int64_t draws = 1;
    std::uint64_t seed = 1;
    std::vector<Comparison> comparisons;
    std::int64_t repeat = 1;
    std::int64_t first = 0;  ///< index of its first case in the study, from 0
    std::int64_t count = 1;  ///< of its cases
};

/// A formula over the rows' values.
struct Claim {
    std::string text;      ///< what is claimed
    std::string formula;   ///< see formula.hpp; names are `case` (its first signal), `case.signal`,
                           ///< `case.signal.spread`
    bool percent = false;  ///< shown in percent
    Bounds bounds;
};

/// A program, its cases, and the paper's figures beside ours.
struct Study {
    std::shared_ptr<const SourceFile> file;
    std::string title;
    std::string program;  ///< path
    std::vector<std::string> notes;
    std::vector<CaseGroup> groups;
    std::vector<Claim> claims;
    std::vector<Setting> parameters;  ///< of the program, in force in the first case
    bool traced = false;              ///< the program has a trace
    std::vector<std::string> include_dirs;
    std::string identity;  ///< hash of all that decides the results: this file, the settings of the
                           ///< command line, the program, its controllers, lineshaft's version

    std::int64_t case_count() const;
    /// A case is made when it is wanted: a study of a million cases is no larger than its file.
    StudyCase make_case(std::int64_t index) const;
};

}  // namespace lineshaft

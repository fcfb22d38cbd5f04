#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "runtime/source/units.hpp"
#include "runtime/study/study.hpp"

namespace lineshaft {

/// A parameter of the program whose value is looked for. Numbers are in `unit`.
struct FitParameter {
    std::string name;
    Unit unit;
    double from = 0, to = 1;  ///< bounds, from < to
    double start = 0.5;
    double step = 1e-3;  ///< of the difference quotients

    /// The value at `share` (0..1) of the way between the bounds; a time in whole nanoseconds.
    double value(double share) const;
    double share(double value) const { return (value - from) / (to - from); }
    /// As it stands in a program: `0.33 ms`.
    std::string text(double value) const;
};

/// What one comparison of a cell is held against: one figure, or the samples of a trace's column.
struct FitTarget {
    std::vector<double> given;  ///< in the signal's unit
    double uncertainty = 1;     ///< differences are counted in it; in the signal's unit, > 0
};

/// A case of the program and what was measured of it.
struct FitCell {
    StudyCase run;  ///< settings without the parameters that are looked for
    bool hold_out = false;
    std::vector<FitTarget> targets = {};  ///< one for one with run.comparisons
    std::vector<std::int64_t> times =
        {};  ///< of the samples in the run [ns], rising; empty: no trace
};

/// Identification as a study: which values of `parameters` bring the cells that are not held out
/// nearest to what was measured, by least squares of (ours - given) / uncertainty.
struct FitPlan {
    std::shared_ptr<const SourceFile> file;
    std::string title;
    std::string program;  ///< path
    std::vector<std::string> notes;
    std::vector<std::string> include_dirs;
    std::vector<FitParameter> parameters;
    std::vector<FitCell> cells;
    std::int64_t starts = 1;  ///< the first at the parameters' `start`, the others at random
    std::uint64_t seed = 1;   ///< of these
    /// Beside the identification every cell, held out there or not, is predicted from all others.
    bool hold_out_each = false;
};

/// Reads and checks a plan: its structure, its program with every cell's settings, its traces.
FitPlan read_fit(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out);

/// True for a file that calls itself a fit.
bool is_fit(const SourceFile& file);

struct FitValue {
    const FitParameter* parameter = nullptr;
    double value = 0;
    double standard_error = 0;              ///< NaN: not determined, see `standard_errors`
    bool at_bound = false;                  ///< within one step of a bound
    std::vector<double> correlations = {};  ///< with every parameter; NaN: not determined
};

/// One comparison of one cell at the values found.
struct FitRow {
    const FitCell* cell = nullptr;
    const Comparison* comparison = nullptr;
    std::size_t samples = 1;
    double given = 0, ours = 0;  ///< of one figure; 0 for a trace
    double difference = 0;       ///< ours - given; of a trace the root mean square
    double residual = 0;         ///< the difference in uncertainties
    bool ok = true;              ///< within the comparison's bounds; a trace has none
};

/// What the other cells say of one cell, searched from the parameters' `start`.
struct FitLeftOut {
    const FitCell* cell = nullptr;
    std::vector<double> values;  ///< found without the cell, one a parameter
    std::vector<FitRow> rows;    ///< the cell at these values; empty: it does not run there
    bool converged = false;
};

/// Standard error of `parameter` by the jackknife: sqrt((n - 1)/n sum of (value - mean)^2) over the
/// n cells left out in turn.
double jackknife_error(const std::vector<FitLeftOut>& left_out, std::size_t parameter);

struct FitStart {
    std::vector<double> values;  ///< where it ended, one a parameter
    double sum = 0;              ///< of squares; infinite: it could not even begin
    bool converged = false;
};

struct FitReport {
    std::vector<FitValue> values;      ///< of the best start; empty: none could begin
    std::vector<FitRow> rows;          ///< in the order of the cells; empty when interrupted
    std::vector<FitLeftOut> left_out;  ///< every cell in turn, if wanted
    std::vector<FitStart> starts;
    std::vector<std::string> faults;  ///< why cells did not run, at the values found
    std::size_t best = 0;             ///< index in `starts`
    std::size_t runs = 0;             ///< of the program
    double wall_seconds = 0;
    bool interrupted = false;

    bool ok() const;
};

struct FitProgress {
    std::size_t start = 1, runs = 0;  ///< counted from 1; so far
    std::size_t left_out = 0;         ///< number of the cell that is left out in turn; 0: none
    double sum = 0;                   ///< least sum of squares so far; infinite: none yet
};

struct FitOptions {
    unsigned jobs = 1;  ///< whole runs side by side
    const std::atomic<bool>* interrupt = nullptr;
    std::function<void(const FitProgress&)> progress = {};  ///< one thread at a time
};

/// Searches from every start; the result does not depend on the number of jobs.
FitReport run(const FitPlan& plan, const Catalog& catalog, const FitOptions& options);

}  // namespace lineshaft

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>

#include <fmt/format.h>

#include "runtime/fit/fit.hpp"
#include "runtime/fit/least_squares.hpp"
#include "runtime/model/random.hpp"
#include "runtime/run/side_by_side.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/study/scatter.hpp"

namespace lineshaft {

namespace {

using Eigen::VectorXd;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Takes the values that signals have at given times: when everything due then has run.
class Sampler : public Observer {
  public:
    Sampler(std::vector<Signal> signals, const std::vector<std::int64_t>& times)
        : signals_(std::move(signals)), times_(times) {
        values_.reserve(signals_.size() * times.size());
    }

    void scanned(int, const Scan&) override {}
    bool looks_at_scans() const override { return false; }
    void settled(std::int64_t, std::int64_t next) override {
        for (; taken_ < times_.size() && times_[taken_] < next; ++taken_)
            for (const Signal& signal : signals_) values_.push_back(as_real(signal.value()));
    }

    std::size_t taken() const { return taken_; }
    double value(std::size_t sample, std::size_t signal) const {
        return values_[sample * signals_.size() + signal];
    }

  private:
    std::vector<Signal> signals_;
    const std::vector<std::int64_t>& times_;
    std::vector<double> values_;
    std::size_t taken_ = 0;
};

/// What one run gave: per comparison its figure, or its samples.
struct Figures {
    std::vector<std::vector<double>> values;
    std::string fault;  ///< why there are none
};

class Fitter {
  public:
    Fitter(const FitPlan& plan, const Catalog& catalog, const FitOptions& options)
        : plan_(plan), catalog_(catalog), options_(options) {}

    FitReport run();

  private:
    struct Job {
        const FitCell* cell;
        VectorXd point;
        std::int64_t repeat;
    };

    bool stopped() const { return options_.interrupt && *options_.interrupt; }
    LeastSquares identify();
    void leave_out_each();
    LeastSquaresOptions search(std::int64_t index);
    LeastSquares minimise_from(const LeastSquaresOptions& options);
    std::vector<VectorXd> residuals(const std::vector<VectorXd>& points);
    std::vector<Figures> figures(const std::vector<const FitCell*>& cells,
                                 const std::vector<VectorXd>& points);
    std::vector<Figures> run_all(const std::vector<Job>& jobs);
    Figures run_one(const Job& job, YamlFiles& files, CompiledSources& sources) const;
    void take_values(const LeastSquares& best);
    void take_rows(const LeastSquares& best);
    std::vector<FitRow> rows(const std::vector<const FitCell*>& cells, const VectorXd& point);

    const FitPlan& plan_;
    const Catalog& catalog_;
    const FitOptions& options_;
    std::vector<const FitCell*> identification_;
    FitReport report_;
    std::string first_fault_;  ///< of the search
    FitProgress progress_{.sum = infinity};
};

std::vector<double> values_at(const FitPlan& plan, const VectorXd& point) {
    std::vector<double> values;
    for (std::size_t i = 0; i < plan.parameters.size(); ++i)
        values.push_back(plan.parameters[i].value(point[static_cast<Eigen::Index>(i)]));
    return values;
}

std::vector<Setting> settings_at(const FitPlan& plan, const FitCell& cell, const VectorXd& point) {
    std::vector<Setting> settings = cell.run.settings;
    const std::vector<double> values = values_at(plan, point);
    for (std::size_t i = 0; i < values.size(); ++i)
        settings.push_back({plan.parameters[i].name, plan.parameters[i].text(values[i])});
    return settings;
}

std::vector<Signal> compared_signals(const FitCell& cell, const Machine& machine) {
    std::vector<Signal> signals;
    for (const Comparison& comparison : cell.run.comparisons)
        signals.push_back(*machine.find(comparison.signal));
    return signals;
}

FitReport Fitter::run() {
    const auto begin = std::chrono::steady_clock::now();
    const LeastSquares best = identify();
    take_values(best);
    take_rows(best);
    if (plan_.hold_out_each && best.residuals.size() > 0) leave_out_each();
    report_.interrupted = stopped();
    report_.runs = progress_.runs;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    report_.wall_seconds = wall.count();
    return std::move(report_);
}

/// From every start, by the cells that are not held out.
LeastSquares Fitter::identify() {
    for (const FitCell& cell : plan_.cells)
        if (!cell.hold_out) identification_.push_back(&cell);
    LeastSquares best;
    double least = infinity;
    for (std::int64_t i = 0; i < plan_.starts && !stopped(); ++i) {
        progress_.start = static_cast<std::size_t>(i) + 1;
        const LeastSquares found = minimise_from(search(i));
        const double sum = found.residuals.size() == 0 ? infinity : found.sum();
        report_.starts.push_back({values_at(plan_, found.point), sum, found.converged});
        if (!(sum < least)) continue;
        least = sum;
        best = found;
        report_.best = report_.starts.size() - 1;
    }
    return best;
}

void Fitter::leave_out_each() {
    for (const FitCell& cell : plan_.cells) {
        if (stopped()) return;
        ++progress_.left_out;
        progress_.sum = infinity;
        identification_.clear();
        for (const FitCell& other : plan_.cells)
            if (&other != &cell) identification_.push_back(&other);
        const LeastSquares found = minimise_from(search(0));
        report_.left_out.push_back({.cell = &cell,
                                    .values = values_at(plan_, found.point),
                                    .rows = rows({&cell}, found.point),
                                    .converged = found.converged});
    }
}

LeastSquares Fitter::minimise_from(const LeastSquaresOptions& options) {
    return minimise([this](const std::vector<VectorXd>& points) { return residuals(points); },
                    options);
}

LeastSquaresOptions Fitter::search(std::int64_t index) {
    const auto n = static_cast<Eigen::Index>(plan_.parameters.size());
    LeastSquaresOptions options;
    options.start.resize(n);
    options.steps.resize(n);
    Random random(plan_.seed + static_cast<std::uint64_t>(index), "start");
    for (Eigen::Index i = 0; i < n; ++i) {
        const FitParameter& p = plan_.parameters[static_cast<std::size_t>(i)];
        const double drawn = std::ldexp(static_cast<double>(random.next() >> 11), -53);
        options.start[i] = index == 0 ? p.share(p.start) : drawn;
        options.steps[i] = p.step / (p.to - p.from);
    }
    options.stop = [this] { return stopped(); };
    return options;
}

/// Residuals of the cells that are not held out; empty where one of them does not run.
std::vector<VectorXd> Fitter::residuals(const std::vector<VectorXd>& points) {
    const std::vector<Figures> all = figures(identification_, points);
    std::vector<VectorXd> out(points.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
        std::vector<double> terms;
        bool whole = true;
        for (std::size_t c = 0; c < identification_.size(); ++c) {
            const FitCell& cell = *identification_[c];
            const Figures& ours = all[p * identification_.size() + c];
            whole = whole && ours.fault.empty();
            if (first_fault_.empty()) first_fault_ = ours.fault;
            for (std::size_t k = 0; whole && k < cell.targets.size(); ++k)
                for (std::size_t i = 0; i < cell.targets[k].given.size(); ++i)
                    terms.push_back((ours.values[k][i] - cell.targets[k].given[i]) /
                                    cell.targets[k].uncertainty);
        }
        if (!whole) continue;
        out[p] = Eigen::Map<VectorXd>(terms.data(), static_cast<Eigen::Index>(terms.size()));
        progress_.sum = std::min(progress_.sum, out[p].squaredNorm());
    }
    return out;
}

/// What a cell's comparisons ask for, over its repeats; the first fault if there is one.
Figures over_repeats(const FitCell& cell, std::span<const Figures> runs) {
    for (const Figures& run : runs)
        if (!run.fault.empty()) return run;
    Figures out = runs.front();
    for (std::size_t k = 0; k < out.values.size(); ++k)
        for (std::size_t i = 0; i < out.values[k].size(); ++i) {
            Scatter scatter;
            for (const Figures& run : runs) scatter.add(run.values[k][i]);
            out.values[k][i] = scatter.value(cell.run.comparisons[k].statistic);
        }
    return out;
}

/// The figures of every cell at every point (points outside, cells inside).
std::vector<Figures> Fitter::figures(const std::vector<const FitCell*>& cells,
                                     const std::vector<VectorXd>& points) {
    std::vector<Job> jobs;
    for (const VectorXd& point : points)
        for (const FitCell* cell : cells)
            for (std::int64_t repeat = 0; repeat < cell->run.repeat; ++repeat)
                jobs.push_back({cell, point, repeat});
    const std::vector<Figures> runs = run_all(jobs);
    std::vector<Figures> all;
    for (std::size_t i = 0; i < jobs.size();) {
        const FitCell& cell = *jobs[i].cell;
        const auto repeats = static_cast<std::size_t>(cell.run.repeat);
        all.push_back(over_repeats(cell, std::span(runs).subspan(i, repeats)));
        i += repeats;
    }
    return all;
}

std::vector<Figures> Fitter::run_all(const std::vector<Job>& jobs) {
    std::vector<Figures> results(jobs.size());
    std::atomic<std::size_t> next = 0;
    std::mutex progress_mutex;
    const auto work = [&] {
        YamlFiles files;
        CompiledSources sources;
        for (std::size_t i = next++; i < jobs.size(); i = next++) {
            results[i] = run_one(jobs[i], files, sources);
            const std::lock_guard lock(progress_mutex);
            ++progress_.runs;
            if (options_.progress) options_.progress(progress_);
        }
    };
    side_by_side(std::min<std::int64_t>(options_.jobs, std::ssize(jobs)), work,
                 [&] { next = jobs.size(); });
    return results;
}

Figures Fitter::run_one(const Job& job, YamlFiles& files, CompiledSources& sources) const {
    if (stopped()) return {.values = {}, .fault = "interrupted"};
    const FitCell& cell = *job.cell;
    Diagnostics out;
    auto loaded = load_program(plan_.program,
                               {settings_at(plan_, cell, job.point), plan_.include_dirs, &files},
                               catalog_, out, &sources);
    if (!loaded) return {.values = {}, .fault = out.render()};
    Machine& machine = loaded->linked.machine;
    machine.seed += static_cast<std::uint64_t>(job.repeat);
    const std::vector<Signal> signals = compared_signals(cell, machine);
    Sampler sampler(signals, cell.times);
    RunOptions options{.trace_path = {}, .interrupt = options_.interrupt, .progress = {}};
    if (!cell.times.empty()) options.observer = &sampler;
    const RunReport report = lineshaft::run(*loaded, options);
    if (report.faulted())
        return {.values = {},
                .fault = fmt::format("{}: {}", describe(cell.run), report.result.message)};
    if (sampler.taken() < cell.times.size())
        return {.values = {},
                .fault = fmt::format("{}: the run ends at {}, the measured trace at {}",
                                     describe(cell.run), format_time(report.result.time),
                                     format_time(cell.times.back()))};
    Figures figures;
    for (std::size_t k = 0; k < signals.size(); ++k) {
        figures.values.emplace_back();
        if (cell.times.empty()) figures.values.back().push_back(as_real(signals[k].value()));
        for (std::size_t i = 0; i < cell.times.size(); ++i)
            figures.values.back().push_back(sampler.value(i, k));
    }
    return figures;
}

void Fitter::take_values(const LeastSquares& best) {
    if (best.residuals.size() == 0) return;
    const VectorXd errors = standard_errors(best);
    const Eigen::MatrixXd related = correlations(best);
    const std::vector<double> values = values_at(plan_, best.point);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const FitParameter& p = plan_.parameters[i];
        const bool at_bound = std::min(values[i] - p.from, p.to - values[i]) < p.step;
        const auto row = static_cast<Eigen::Index>(i);
        const double error = errors[row] * (p.to - p.from);
        const VectorXd with = related.row(row);
        report_.values.push_back({&p, values[i], error, at_bound, {with.begin(), with.end()}});
    }
}

FitRow make_row(const FitCell& cell, std::size_t k, const std::vector<double>& ours) {
    const FitTarget& target = cell.targets[k];
    FitRow row{.cell = &cell, .comparison = &cell.run.comparisons[k], .samples = ours.size()};
    double squares = 0;
    for (std::size_t i = 0; i < ours.size(); ++i)
        squares += (ours[i] - target.given[i]) * (ours[i] - target.given[i]);
    row.difference = std::sqrt(squares / static_cast<double>(ours.size()));
    if (cell.times.empty()) {
        row.given = target.given.front();
        row.ours = ours.front();
        row.difference = row.ours - row.given;
        row.ok = row.comparison->bounds.hold(row.ours);
    }
    row.residual = row.difference / target.uncertainty;
    return row;
}

/// All cells once more, those that were held out for the first time.
void Fitter::take_rows(const LeastSquares& best) {
    if (stopped()) return;
    std::vector<const FitCell*> cells;
    for (const FitCell& cell : plan_.cells) cells.push_back(&cell);
    const bool any = best.residuals.size() > 0;
    report_.rows = rows(cells, any ? best.point : search(0).start);
    if (any) return;
    report_.rows.clear();
    if (report_.faults.empty() && !first_fault_.empty()) report_.faults.push_back(first_fault_);
}

/// A row for each of the cells that run.
std::vector<FitRow> Fitter::rows(const std::vector<const FitCell*>& cells, const VectorXd& point) {
    std::vector<FitRow> made;
    const std::vector<Figures> all = figures(cells, {point});
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (!all[c].fault.empty()) report_.faults.push_back(all[c].fault);
        for (std::size_t k = 0; k < all[c].values.size(); ++k)
            made.push_back(make_row(*cells[c], k, all[c].values[k]));
    }
    return made;
}

}  // namespace

double FitParameter::value(double share) const {
    const double exact = std::clamp(from + share * (to - from), from, to);
    static const Unit second = Unit::parse("s").value(), ns = Unit::parse("ns").value();
    if (!unit.same_dimension(second)) return exact;
    return convert(std::round(convert(exact, unit, ns)), ns, unit);
}

std::string FitParameter::text(double value) const {
    return format_number(value) + (unit.text.empty() ? "" : " " + unit.text);
}

double jackknife_error(const std::vector<FitLeftOut>& left_out, std::size_t parameter) {
    Scatter scatter;
    for (const FitLeftOut& one : left_out) scatter.add(one.values[parameter]);
    const double n = static_cast<double>(left_out.size());
    return scatter.spread() * (n - 1) / std::sqrt(n);
}

bool FitReport::ok() const {
    const auto holds = [](const FitLeftOut& one) {
        return std::ranges::all_of(one.rows, &FitRow::ok);
    };
    return !values.empty() && faults.empty() && !interrupted &&
           std::ranges::all_of(rows, &FitRow::ok) && std::ranges::all_of(left_out, holds);
}

FitReport run(const FitPlan& plan, const Catalog& catalog, const FitOptions& options) {
    return Fitter(plan, catalog, options).run();
}

}  // namespace lineshaft

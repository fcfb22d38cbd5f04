#include "runtime/study/study_runner.hpp"

#include <algorithm>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "runtime/run/side_by_side.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/study/scatter.hpp"

namespace lineshaft {

namespace {

constexpr std::int64_t waiting_per_job = 32;

/// One thread's: the program's files are parsed once.
class CaseRunner {
  public:
    CaseRunner(const Study& study, const Catalog& catalog, const CaseOptions& options)
        : study_(study), catalog_(catalog), options_(options) {}

    /// Empty when interrupted.
    std::optional<CaseResult> run(std::int64_t index);

  private:
    CaseResult run_all(const std::shared_ptr<const StudyCase>& of, bool traced);
    bool run_once(std::int64_t repeat, bool traced, CaseResult& result);
    bool judge(const RunReport& report, CaseResult& result);
    std::string trace_path(const StudyCase& of, std::int64_t repeat) const;
    bool measure(const Machine& machine, CaseResult& result);

    const Study& study_;
    const Catalog& catalog_;
    const CaseOptions& options_;
    YamlFiles files_;
    CompiledSources sources_;
    std::vector<Scatter> scatters_;
    bool interrupted_ = false;
};

std::optional<CaseResult> CaseRunner::run(std::int64_t index) {
    const auto of = std::make_shared<StudyCase>(study_.make_case(index));
    const CaseTraces& traces = options_.traces;
    CaseResult result = run_all(of, !traces.folder.empty() && !traces.of_failed);
    if (!interrupted_ && !traces.folder.empty() && traces.of_failed && !result.ok())
        result = run_all(of, true);
    return interrupted_ ? std::nullopt : std::optional(std::move(result));
}

CaseResult CaseRunner::run_all(const std::shared_ptr<const StudyCase>& of, bool traced) {
    CaseResult result;
    result.of = of;
    const double infinity = std::numeric_limits<double>::infinity();
    result.values.assign(of->comparisons.size(),
                         Measured{.least = infinity, .greatest = -infinity});
    scatters_.assign(of->comparisons.size(), {});
    bool whole = true;
    for (std::int64_t repeat = 0; whole && repeat < of->repeat; ++repeat)
        whole = run_once(repeat, traced, result);
    if (!whole) result.values.clear();
    for (std::size_t k = 0; k < result.values.size(); ++k) {
        const Statistic statistic = of->comparisons[k].statistic;
        const double ours = scatters_[k].value(statistic);
        if (statistic == Statistic::spread) result.values[k] = {ours, ours, ours};
        result.values[k].ours = ours;
    }
    return result;
}

std::string CaseRunner::trace_path(const StudyCase& of, std::int64_t repeat) const {
    return fmt::format("{}/{}{}.csv", options_.traces.folder, file_stem(of, study_.case_count()),
                       of.repeat > 1 ? fmt::format(".{}", repeat + 1) : "");
}

bool CaseRunner::run_once(std::int64_t repeat, bool traced, CaseResult& result) {
    Diagnostics out;
    auto loaded = load_program(study_.program, {result.of->settings, study_.include_dirs, &files_},
                               catalog_, out, &sources_);
    if (!loaded) {
        const Diagnostic& first = out.list().front();
        result.faults.push_back(fmt::format("{} [{}]", first.message, first.code));
        return false;
    }
    Machine& machine = loaded->linked.machine;
    machine.seed += static_cast<std::uint64_t>(repeat);
    result.parameters = loaded->program.parameters;
    const std::string trace = traced ? trace_path(*result.of, repeat) : "";
    const RunReport report = lineshaft::run(
        *loaded,
        {.trace_path = trace, .flush = false, .interrupt = options_.interrupt, .progress = {}});
    for (const TraceReport& written : report.traces)
        result.traces.insert(result.traces.end(), written.paths.begin(), written.paths.end());
    return judge(report, result) && measure(machine, result);
}

/// Whether the run came to its end.
bool CaseRunner::judge(const RunReport& report, CaseResult& result) {
    interrupted_ = report.result.outcome == Outcome::interrupted && report.output_error.empty();
    if (interrupted_) return false;
    result.machine_seconds += seconds(report.result.time);
    result.output_error = report.output_error;
    if (!result.output_error.empty()) return false;
    if (report.faulted()) result.faults.push_back(report.result.message);
    for (const Verdict& verdict : report.verdicts)
        if (!verdict.ok && !(report.faulted() && verdict.undecided))  // the fault says why
            result.deviations.push_back(verdict.deviation);
    return !report.faulted();
}

bool CaseRunner::measure(const Machine& machine, CaseResult& result) {
    const auto& comparisons = result.of->comparisons;
    for (std::size_t k = 0; k < comparisons.size(); ++k) {
        const Signal* signal = machine.find(comparisons[k].signal);
        if (!signal || signal->unit != comparisons[k].unit) {
            result.faults.push_back(fmt::format(
                "'{}' is not in {} here, as it is in the first case beside it: write this case as "
                "an item of its own",
                comparisons[k].signal, comparisons[k].unit));
            return false;
        }
        const double value = as_real(signal->value());
        Measured& measured = result.values[k];
        scatters_[k].add(value);
        measured.least = std::min(measured.least, value);
        measured.greatest = std::max(measured.greatest, value);
    }
    return true;
}

/// Gives out cases, and brings their results into order.
class Queue {
  public:
    Queue(CaseRange range, const CaseOptions& options,
          const std::function<bool(const CaseResult&)>& take)
        : last_(range.last),
          window_(waiting_per_job * options.jobs),
          options_(options),
          take_(take),
          next_(range.first),
          expected_(range.first) {}

    /// Empty: there is nothing more to do.
    std::optional<std::int64_t> next() {
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [this] { return over() || next_ < expected_ + window_; });
            if (over()) return {};
            const std::int64_t index = next_++;
            if (!take_known(index)) return index;
        }
    }

    /// Empty: interrupted.
    void put(std::int64_t index, std::optional<CaseResult> result) {
        if (!result) return stop();
        const std::lock_guard lock(mutex_);
        insert(index, std::move(*result));
        changed_.notify_all();
    }

    void stop() {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
        changed_.notify_all();
    }

    std::map<std::int64_t, CaseResult> waiting() { return std::move(ready_); }

  private:
    bool over() const {
        return stopped_ || next_ >= last_ || (options_.interrupt && *options_.interrupt);
    }

    bool take_known(std::int64_t index) {
        if (!options_.known) return false;
        auto node = options_.known->extract(index);
        if (!node) return false;
        insert(index, std::move(node.mapped()));
        return true;
    }

    void insert(std::int64_t index, CaseResult result) {
        ready_.emplace(index, std::move(result));
        for (auto it = ready_.begin(); !stopped_ && it != ready_.end() && it->first == expected_;
             it = ready_.erase(it), ++expected_)
            stopped_ = !take_(it->second);
    }

    const std::int64_t last_, window_;
    const CaseOptions& options_;
    const std::function<bool(const CaseResult&)>& take_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::int64_t, CaseResult> ready_;
    std::int64_t next_, expected_;
    bool stopped_ = false;
};

}  // namespace

bool CaseResult::holds(std::size_t comparison) const {
    return values.empty() || of->comparisons[comparison].bounds.hold(values[comparison].ours);
}

bool CaseResult::ok() const {
    if (!faults.empty() || !deviations.empty()) return false;
    for (std::size_t k = 0; k < values.size(); ++k)
        if (!holds(k)) return false;
    return true;
}

std::map<std::int64_t, CaseResult> run_cases(const Study& study, const Catalog& catalog,
                                             CaseRange range, const CaseOptions& options,
                                             const std::function<bool(const CaseResult&)>& take) {
    Queue queue(range, options, take);
    const auto work = [&] {
        CaseRunner runner(study, catalog, options);
        while (const auto index = queue.next()) queue.put(*index, runner.run(*index));
    };
    side_by_side(std::min<std::int64_t>(options.jobs, range.count()), work, [&] { queue.stop(); });
    return queue.waiting();
}

}  // namespace lineshaft

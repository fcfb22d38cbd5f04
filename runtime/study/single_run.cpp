#include "runtime/study/single_run.hpp"

#include <algorithm>
#include <chrono>
#include <deque>

#include "runtime/trace/pulse_writer.hpp"
#include "runtime/trace/trace_files.hpp"

namespace lineshaft {

namespace {

/// One trace while it is recorded.
struct Tracing {
    Tracing(const TraceSetup& setup, const Program& program, const RunOptions& options)
        : name(setup.name),
          files(options.trace_path, setup, program.title, program.file->text, options.csv_style),
          recorder(setup, files) {}

    TraceReport finish(const RunResult& result, const Judge& judge) {
        files.set_outcome(result.message, verdicts_json(judge));
        recorder.finish();
        if (recorder.measurements() == 0) {
            files.begin();
            files.end();
        }
        return {name, files.paths(), recorder.measurements(), recorder.recorded()};
    }

    std::string name;
    TraceFiles files;
    Recorder recorder;
};

/// Stops a run when the user wants it, or when what it records cannot be written.
class StopWatch {
  public:
    StopWatch(const RunOptions& options, const std::deque<Tracing>& traces,
              const std::optional<PulseWriter>& pulses)
        : options_(options), traces_(traces), pulses_(pulses) {}

    void look(std::int64_t time) {
        if (options_.progress) options_.progress(time);
        if (writing_fails() || (options_.interrupt && *options_.interrupt)) stop_ = true;
    }

    bool writing_fails() const {
        return (pulses_ && pulses_->failed()) ||
               std::ranges::any_of(traces_, [](const Tracing& t) { return t.files.failed(); });
    }

    const std::atomic<bool>* stop() const { return &stop_; }

  private:
    const RunOptions& options_;
    const std::deque<Tracing>& traces_;
    const std::optional<PulseWriter>& pulses_;
    std::atomic<bool> stop_ = false;
};

}  // namespace

std::optional<Loaded> load_program(const std::string& path, const LoadOptions& options,
                                   const Catalog& catalog, Diagnostics& out) {
    const auto file = options.files ? options.files->source(path, out) : read_source(path, out);
    if (!file) return {};
    Loaded loaded{.program = read_program(file, options, out), .linked = {}};
    loaded.linked = link(loaded.program, catalog, out);
    if (!out.empty()) return {};
    return loaded;
}

bool RunReport::expectations_hold() const {
    return std::ranges::all_of(verdicts, &Verdict::ok);
}

RunReport run(Loaded& loaded, const RunOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    RunReport report;
    Judge judge(loaded.linked.expectations);
    std::vector<Observer*> observers;
    std::deque<Tracing> traces;
    if (!options.trace_path.empty())
        for (const TraceSetup& setup : loaded.linked.traces)
            observers.push_back(&traces.emplace_back(setup, loaded.program, options).recorder);
    std::optional<PulseWriter> pulses;
    if (!options.pulses_path.empty()) pulses.emplace(options.pulses_path, loaded.linked.machine);
    if (!loaded.linked.expectations.empty()) observers.push_back(&judge);
    if (options.observer) observers.push_back(options.observer);
    Executive executive(loaded.linked.machine);
    StopWatch watch(options, traces, pulses);
    report.result =
        executive.run(observers, watch.stop(), [&watch](std::int64_t time) { watch.look(time); });
    if (report.result.outcome == Outcome::interrupted && watch.writing_fails())
        report.result.message = "the run stopped at " + format_time(report.result.time);
    judge.finish(report.result);
    report.verdicts = judge.verdicts();
    for (Tracing& trace : traces) {
        report.traces.push_back(trace.finish(report.result, judge));
        if (report.trace_error.empty()) report.trace_error = trace.files.error();
    }
    if (pulses) report.pulses_error = pulses->finish(report.result.message);
    for (DeviceCall& device : loaded.linked.machine.devices) device.sink = nullptr;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    report.wall_seconds = wall.count();
    return report;
}

}  // namespace lineshaft

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

    TraceReport finish(const Judge& judge) {
        files.set_expectations(verdicts_json(judge));
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
    report.result = executive.run(observers, options.interrupt, options.progress);
    judge.finish(report.result);
    report.verdicts = judge.verdicts();
    for (Tracing& trace : traces) {
        report.traces.push_back(trace.finish(judge));
        if (report.trace_error.empty()) report.trace_error = trace.files.error();
    }
    if (pulses) report.pulses_error = pulses->finish();
    for (DeviceCall& device : loaded.linked.machine.devices) device.sink = nullptr;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    report.wall_seconds = wall.count();
    return report;
}

}  // namespace lineshaft

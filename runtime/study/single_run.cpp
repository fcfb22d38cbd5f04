#include "runtime/study/single_run.hpp"

#include <algorithm>
#include <chrono>

#include "runtime/trace/background_sink.hpp"
#include "runtime/trace/csv_writer.hpp"
#include "runtime/trace/pulse_writer.hpp"

namespace lineshaft {

std::optional<Loaded> load_program(const std::string& path, const LoadOptions& options,
                                   const Catalog& catalog, Diagnostics& out) {
    const auto file = read_source(path, out);
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
    std::optional<CsvWriter> csv;
    std::optional<BackgroundSink> background;
    std::optional<Recorder> recorder;
    if (!options.trace_path.empty() && loaded.linked.trace) {
        csv.emplace(options.trace_path, *loaded.linked.trace);
        background.emplace(*csv, 2 + loaded.linked.trace->signals.size());
        recorder.emplace(*loaded.linked.trace, *background);
        observers.push_back(&*recorder);
    }
    std::optional<PulseWriter> pulses;
    if (!options.pulses_path.empty()) pulses.emplace(options.pulses_path, loaded.linked.machine);
    if (!loaded.linked.expectations.empty()) observers.push_back(&judge);
    Executive executive(loaded.linked.machine);
    report.result = executive.run(observers, options.interrupt, options.progress);
    judge.finish(report.result);
    report.verdicts = judge.verdicts();
    if (recorder) {
        recorder->flush();
        background->finish();
        report.trace_error =
            csv->finish(loaded.program.title, loaded.program.file->text, verdicts_json(judge));
    }
    if (pulses) report.pulses_error = pulses->finish();
    for (DeviceCall& device : loaded.linked.machine.devices) device.sink = nullptr;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    report.wall_seconds = wall.count();
    return report;
}

}  // namespace lineshaft

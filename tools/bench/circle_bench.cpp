#include <algorithm>
#include <bit>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "runtime/trace/csv_writer.hpp"
#include "runtime/trace/event_writer.hpp"
#include "tools/bench/circle_trace.hpp"
#include "tools/bench/hand_circle.hpp"
#include "tools/bench/quickest.hpp"

using namespace lineshaft;

namespace {

std::string file() {
    return (std::filesystem::temp_directory_path() / "lineshaft_circle_bench.csv").string();
}

void remove_file() {
    std::filesystem::remove(file());
    std::filesystem::remove(file() + "-metadata.json");
    std::filesystem::remove(events_path(file()));
}

void by_hand(benchmark::State& state) {
    std::size_t clocks = 0;
    Quickest quickest;
    for (auto _ : state) {
        clocks = 0;
        HandCircle circle;
        quickest.time(
            [&] { circle.run([&](const auto&, const auto&, const auto&) { ++clocks; }); });
        benchmark::DoNotOptimize(circle);
    }
    quickest.count(state, clocks);
}

/// The executive, with or without a trace kept in memory.
void executive(benchmark::State& state, bool traced) {
    Loaded loaded = load_circle();
    Machine& machine = loaded.linked.machine;
    const BlockMemory start = machine.memory;
    MemoryTrace memory(loaded.linked.traces.front());
    RunResult result;
    Quickest quickest;
    for (auto _ : state) {
        std::ranges::copy(start, machine.memory.begin());
        memory.words.clear();
        Recorder recorder(loaded.linked.traces.front(), memory);
        std::vector<Observer*> observers;
        if (traced) observers.push_back(&recorder);
        Executive executive(machine);
        quickest.time([&] {
            result = executive.run(observers);
            recorder.finish();
        });
    }
    quickest.count(state, static_cast<std::size_t>(result.scans.front()));
    std::size_t scans = 0, block_scans = 0;
    for (std::size_t task = 0; task < machine.tasks.size(); ++task) {
        const auto count = static_cast<std::size_t>(result.scans[task]);
        scans += count;
        block_scans += count * machine.tasks[task].infos.size();
    }
    quickest.count(state, scans, "scan");
    quickest.count(state, block_scans, "block_scan");
}

/// A whole run with its trace in a file, as `lineshaft run --trace` makes it.
void traced_to_file(benchmark::State& state) {
    Loaded loaded = load_circle();
    const BlockMemory start = loaded.linked.machine.memory;
    RunReport report;
    Quickest quickest;
    for (auto _ : state) {
        std::ranges::copy(start, loaded.linked.machine.memory.begin());
        quickest.time([&] { report = run(loaded, {.trace_path = file(), .progress = {}}); });
    }
    quickest.count(state, static_cast<std::size_t>(report.result.scans.front()));
    remove_file();
}

/// The other half of it alone: the same files.
void files_alone(benchmark::State& state) {
    const RecordedCircle circle;
    Quickest quickest;
    for (auto _ : state) {
        std::string error;
        quickest.time([&] {
            EventWriter events(events_path(file()), circle.loaded.linked.machine);
            CsvWriter writer(file(), circle.setup);
            for (const RunEvent& event : circle.events.list) events.happened(event);
            writer.rows(circle.words.data(), circle.rows());
            OutputSet files;
            writer.hand_over(files, csv_sidecar(writer.written(), {}, {}, {}));
            events.finish(files);
            files.commit();
            error = files.error();
        });
        if (!error.empty()) state.SkipWithError(error.c_str());
    }
    quickest.count(state, circle.rows());
    remove_file();
}

/// Empty, or where the two circles part.
std::string difference() {
    const RecordedCircle traced;
    std::vector<std::uint64_t> by_hand;
    HandCircle circle;
    circle.run([&](const auto& g, const auto& x, const auto& y) {
        for (const double position : {g.position, x.position, y.position})
            by_hand.push_back(std::bit_cast<std::uint64_t>(position));
    });
    if (by_hand.size() != 3 * traced.rows())
        return fmt::format("{} clocks, by hand {}", traced.rows(), by_hand.size() / 3);
    for (std::size_t row = 0; row < traced.rows(); ++row)
        for (std::size_t i = 0; i < 3; ++i)
            if (traced.words[row * traced.row_words + 2 + i] != by_hand[row * 3 + i])
                return fmt::format("'{}' in clock {}", traced.setup.signals[i].name, row);
    return {};
}

}  // namespace

BENCHMARK(by_hand);
BENCHMARK_CAPTURE(executive, untraced, false);
BENCHMARK_CAPTURE(executive, in_memory, true);
BENCHMARK(traced_to_file)->MinTime(0.2);
BENCHMARK(files_alone)->MinTime(0.2);

int main(int count, char** arguments) {
    if (const std::string where = difference(); !where.empty()) {
        fmt::print(stderr, "the circle by hand is not the program's circle: {}\n", where);
        return 1;
    }
    benchmark::Initialize(&count, arguments);
    benchmark::RunSpecifiedBenchmarks();
}

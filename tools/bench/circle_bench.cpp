#include <bit>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "runtime/trace/csv_writer.hpp"
#include "tools/bench/circle_trace.hpp"
#include "tools/bench/hand_circle.hpp"

using namespace lineshaft;

namespace {

std::string file() {
    return (std::filesystem::temp_directory_path() / "lineshaft_circle_bench.csv").string();
}

void remove_file() {
    std::filesystem::remove(file());
    std::filesystem::remove(file() + "-metadata.json");
}

void by_hand(benchmark::State& state) {
    std::int64_t clocks = 0;
    for (auto _ : state) {
        clocks = 0;
        HandCircle circle;
        circle.run([&](const auto&, const auto&, const auto&) { ++clocks; });
        benchmark::DoNotOptimize(circle);
    }
    state.SetItemsProcessed(state.iterations() * clocks);
}

/// The executive, with or without a trace kept in memory.
void executive(benchmark::State& state, bool traced) {
    std::int64_t clocks = 0;
    for (auto _ : state) {
        state.PauseTiming();
        Loaded loaded = load_circle();
        MemoryTrace memory(loaded.linked.traces.front());
        memory.words.reserve(20'000 * memory.row_words);
        Recorder recorder(loaded.linked.traces.front(), memory);
        std::vector<Observer*> observers;
        if (traced) observers.push_back(&recorder);
        Executive executive(loaded.linked.machine);
        state.ResumeTiming();
        const RunResult result = executive.run(observers);
        recorder.finish();
        benchmark::DoNotOptimize(memory.words.data());
        clocks = result.scans.front();
    }
    state.SetItemsProcessed(state.iterations() * clocks);
}

/// A whole run with its trace in a file, as `lineshaft run --trace` makes it.
void traced_to_file(benchmark::State& state) {
    std::int64_t clocks = 0;
    for (auto _ : state) {
        state.PauseTiming();
        Loaded loaded = load_circle();
        state.ResumeTiming();
        clocks = run(loaded, {.trace_path = file(), .progress = {}}).result.scans.front();
    }
    state.SetItemsProcessed(state.iterations() * clocks);
    remove_file();
}

/// The other half of it alone: the same rows to the same file.
void rows_to_file(benchmark::State& state) {
    const RecordedCircle circle;
    for (auto _ : state) {
        CsvWriter writer(file(), circle.setup);
        writer.rows(circle.words.data(), circle.rows());
        const std::string error = writer.finish("", "");
        if (!error.empty()) state.SkipWithError(error.c_str());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(circle.rows()));
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
BENCHMARK(traced_to_file)->UseRealTime();
BENCHMARK(rows_to_file)->UseRealTime();

int main(int count, char** arguments) {
    if (const std::string where = difference(); !where.empty()) {
        fmt::print(stderr, "the circle by hand is not the program's circle: {}\n", where);
        return 1;
    }
    benchmark::Initialize(&count, arguments);
    benchmark::RunSpecifiedBenchmarks();
}

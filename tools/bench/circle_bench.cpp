#include <bit>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/study/single_run.hpp"
#include "runtime/trace/csv_writer.hpp"
#include "tools/bench/hand_circle.hpp"

using namespace lineshaft;

namespace {

constexpr std::int64_t blocks_a_clock = 7;
const std::string program = LINESHAFT_SOURCE_DIR "/programs/paper/wei2025_circle.yaml";

Loaded load() {
    Diagnostics problems;
    auto loaded = load_program(program, {}, standard_blocks(), problems);
    if (!loaded) throw std::runtime_error("cannot load " + program);
    return std::move(*loaded);
}

/// Keeps a trace's rows.
struct Memory : TraceSink {
    void rows(const std::uint64_t* words, std::size_t rows) override {
        kept.insert(kept.end(), words, words + rows * row_words);
    }
    std::size_t row_words = 0;
    std::vector<std::uint64_t> kept;
};

void count(benchmark::State& state, std::int64_t clocks) {
    state.SetItemsProcessed(state.iterations() * clocks);
    state.counters["blocks"] = static_cast<double>(blocks_a_clock);
}

void by_hand(benchmark::State& state) {
    std::int64_t clocks = 0;
    for (auto _ : state) {
        clocks = 0;
        HandCircle circle;
        circle.run([&](const auto&, const auto&, const auto&) { ++clocks; });
        benchmark::DoNotOptimize(circle);
    }
    count(state, clocks);
}

/// The executive, with or without a trace kept in memory.
void executive(benchmark::State& state, bool traced) {
    std::int64_t clocks = 0;
    for (auto _ : state) {
        state.PauseTiming();
        Loaded loaded = load();
        Memory memory;
        memory.row_words = 2 + loaded.linked.trace->signals.size();
        memory.kept.reserve(20'000 * memory.row_words);
        Recorder recorder(*loaded.linked.trace, memory);
        std::vector<Observer*> observers;
        if (traced) observers.push_back(&recorder);
        Executive executive(loaded.linked.machine);
        state.ResumeTiming();
        const RunResult result = executive.run(observers);
        recorder.flush();
        benchmark::DoNotOptimize(memory.kept.data());
        clocks = result.scans.front();
    }
    count(state, clocks);
}

/// A whole run with its trace in a file, as `lineshaft run --trace` makes it.
void traced_to_file(benchmark::State& state) {
    const std::string path =
        (std::filesystem::temp_directory_path() / "lineshaft_circle_bench.csv").string();
    std::int64_t clocks = 0;
    for (auto _ : state) {
        state.PauseTiming();
        Loaded loaded = load();
        state.ResumeTiming();
        clocks = run(loaded, {.trace_path = path, .progress = {}}).result.scans.front();
    }
    count(state, clocks);
    std::filesystem::remove(path);
    std::filesystem::remove(path + "-metadata.json");
}

/// The other half of it alone: the same rows to the same file.
void rows_to_file(benchmark::State& state) {
    const std::string path =
        (std::filesystem::temp_directory_path() / "lineshaft_circle_bench.csv").string();
    Loaded loaded = load();
    Memory memory;
    memory.row_words = 2 + loaded.linked.trace->signals.size();
    Recorder recorder(*loaded.linked.trace, memory);
    Executive(loaded.linked.machine).run({&recorder});
    recorder.flush();
    const std::size_t rows = memory.kept.size() / memory.row_words;
    for (auto _ : state) {
        CsvWriter writer(path, *loaded.linked.trace);
        writer.rows(memory.kept.data(), rows);
        const std::string error = writer.finish("", "");
        if (!error.empty()) state.SkipWithError(error.c_str());
    }
    count(state, static_cast<std::int64_t>(rows));
    state.counters["values"] = static_cast<double>(memory.row_words);
    std::filesystem::remove(path);
    std::filesystem::remove(path + "-metadata.json");
}

/// Empty, or where the two circles part.
std::string difference() {
    Loaded loaded = load();
    Memory memory;
    TraceSetup setup{.task = loaded.linked.trace->task, .signals = {}};
    for (const char* name : {"g.position", "x.position", "y.position"})
        setup.signals.push_back(*loaded.linked.machine.find(name));
    memory.row_words = 2 + setup.signals.size();
    Recorder recorder(setup, memory);
    Executive(loaded.linked.machine).run({&recorder});
    recorder.flush();
    std::vector<std::uint64_t> by_hand;
    HandCircle circle;
    circle.run([&](const auto& g, const auto& x, const auto& y) {
        for (const double position : {g.position, x.position, y.position})
            by_hand.push_back(std::bit_cast<std::uint64_t>(position));
    });
    const std::size_t rows = memory.kept.size() / memory.row_words;
    if (by_hand.size() != 3 * rows)
        return fmt::format("{} clocks, by hand {}", rows, by_hand.size() / 3);
    for (std::size_t i = 0; i < by_hand.size(); ++i)
        if (memory.kept[i / 3 * 5 + 2 + i % 3] != by_hand[i])
            return fmt::format("'{}' in clock {}", setup.signals[i % 3].name, i / 3);
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

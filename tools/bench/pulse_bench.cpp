#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "blocks/pulse/pto.hpp"
#include "blocks/pulse/pulse_train.hpp"
#include "runtime/trace/pulse_writer.hpp"
#include "tools/bench/quickest.hpp"

using namespace lineshaft;

namespace {

constexpr std::int64_t pulses = 1'000'000;
constexpr std::int64_t late = never / 2;

/// One ramp's edges, written to memory in pieces as a channel does.
void edges(benchmark::State& state, const PulseSegment& segment, RateUpdate update) {
    std::vector<std::int64_t> out(1024);
    PulseTrain train;
    Quickest quickest;
    for (auto _ : state) {
        quickest.time([&] {
            train.begin(segment, update, {});
            while (train.take(late, out) > 0) benchmark::DoNotOptimize(out.data());
        });
    }
    quickest.count(state, pulses);
}

/// Edges from a channel into a CSV file.
void csv(benchmark::State& state) {
    const std::string path =
        (std::filesystem::temp_directory_path() / "lineshaft_pulse_bench.csv").string();
    std::vector<std::int64_t> out(1024);
    Quickest quickest;
    for (auto _ : state) {
        std::string error;
        quickest.time([&] {
            Machine machine;
            machine.devices.push_back({.calls = {}, .block = nullptr, .name = "x"});
            PulseWriter writer(path, machine);
            PulseTrain train;
            train.begin({1000, 100'000, pulses}, RateUpdate::continuous, {});
            for (std::size_t n = train.take(late, out); n > 0; n = train.take(late, out))
                machine.devices[0].sink->edges(std::span(out).first(n), false);
            OutputSet files;
            writer.finish(files, {});
            files.commit();
            error = files.error();
        });
        if (!error.empty()) state.SkipWithError(error.c_str());
    }
    quickest.count(state, pulses);
    std::filesystem::remove(path);
}

}  // namespace

BENCHMARK_CAPTURE(edges, continuous_ramp, PulseSegment{1000, 100'000, pulses},
                  RateUpdate::continuous);
BENCHMARK_CAPTURE(edges, continuous_constant, PulseSegment{33'333, 33'333, pulses},
                  RateUpdate::continuous);
BENCHMARK_CAPTURE(edges, per_pulse_ramp, PulseSegment{1000, 100'000, pulses},
                  RateUpdate::per_pulse);
BENCHMARK(csv);
BENCHMARK_MAIN();

#include <memory>
#include <stdexcept>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/program/link.hpp"
#include "runtime/scan/executive.hpp"

using namespace lineshaft;

namespace {

constexpr std::int64_t scans = 1000;

Linked linked(const std::string& text) {
    Diagnostics problems;
    const auto file = std::make_shared<const SourceFile>(SourceFile{"generated.yaml", text});
    const Program program = read_program(file, {}, problems);
    Linked result = link(program, standard_blocks(), problems);
    if (!problems.empty()) throw std::runtime_error(problems.render());
    return result;
}

std::string head() {
    return fmt::format(
        "lineshaft: 1\ntasks: {{m: {{every: 1 ms}}}}\nrun: {{for: {} ms}}\nblocks:\n", scans - 1);
}

/// Chains of an oscillating timer, an edge, a counter and a filter; each chain's counter is reset
/// by the edge of the chain before.
std::string small_blocks(std::int64_t chains) {
    std::string text = head();
    for (std::int64_t i = 0; i < chains; ++i) {
        const std::string reset = i == 0 ? "" : fmt::format(", r: e{}.q", i - 1);
        text += fmt::format(
            "  t{0}: {{type: ton, task: m, in: NOT previous(t{0}.q), pt: {1} ms}}\n"
            "  e{0}: {{type: r_trig, task: m, clk: t{0}.q}}\n"
            "  c{0}: {{type: ctu, task: m, cu: e{0}.q, pv: 10{2}}}\n"
            "  f{0}: {{type: filter_pt1, task: m, in: c{0}.cv, time_constant: 5 ms}}\n",
            i, 3 + i % 7, reset);
    }
    return text;
}

/// One of the axes is the shaft. 8,000 is what the loader's 100,000 values admit.
std::string gear_axes(std::int64_t axes) {
    std::string text = head() + "  a: {type: virtual_axis, task: m, velocity: 10 mm/s}\n";
    for (std::int64_t i = 0; i < axes - 1; ++i)
        text += fmt::format(
            "  s{}: {{type: gear_axis, task: m, master_position: a.position, "
            "master_velocity: a.velocity, ratio: {}}}\n",
            i, 1 + i % 5);
    return text;
}

/// Time of a scan, and of a block in it, over a second of machine time from its first scan on.
void run(benchmark::State& state, const std::string& text, std::int64_t blocks) {
    for (auto _ : state) {
        state.PauseTiming();
        auto machine = std::make_unique<Linked>(linked(text));
        Executive executive(machine->machine);
        state.ResumeTiming();
        benchmark::DoNotOptimize(executive.run({}));
        state.PauseTiming();
        machine.reset();
        state.ResumeTiming();
    }
    state.SetItemsProcessed(state.iterations() * scans);
    state.counters["blocks"] = static_cast<double>(blocks);
}

void small(benchmark::State& state) {
    run(state, small_blocks(state.range(0) / 4), state.range(0));
}

void axes(benchmark::State& state) {
    run(state, gear_axes(state.range(0)), state.range(0));
}

/// Reading, checking and wiring a program.
void load(benchmark::State& state) {
    const std::string text = small_blocks(state.range(0) / 4);
    for (auto _ : state) benchmark::DoNotOptimize(linked(text));
    state.counters["blocks"] = static_cast<double>(state.range(0));
}

}  // namespace

BENCHMARK(small)->Arg(100)->Arg(1000);
BENCHMARK(axes)->Arg(10)->Arg(100)->Arg(1000)->Arg(8'000);
BENCHMARK(load)->Arg(1000)->Arg(2000)->Arg(4000);
BENCHMARK_MAIN();

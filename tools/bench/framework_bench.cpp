#include <algorithm>
#include <bit>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/run/link.hpp"
#include "runtime/scan/executive.hpp"
#include "tools/bench/hand_small_blocks.hpp"
#include "tools/bench/quickest.hpp"

using namespace lineshaft;

namespace {

constexpr std::size_t scans = 1000;

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
        "lineshaft: 1\ntasks: {{m: {{every: {} ns}}}}\nrun: {{for: {} ns}}\nblocks:\n",
        small_interval, static_cast<std::int64_t>(scans - 1) * small_interval);
}

/// The program of hand_small_blocks.hpp.
std::string small_blocks(std::size_t chains) {
    std::string text = head();
    for (std::size_t i = 0; i < chains; ++i) {
        const std::string reset = i == 0 ? "" : fmt::format(", r: e{}.q", i - 1);
        text += fmt::format(
            "  t{0}: {{type: ton, task: m, in: NOT previous(t{0}.q), pt: {1} ns}}\n"
            "  e{0}: {{type: r_trig, task: m, clk: t{0}.q}}\n"
            "  c{0}: {{type: ctu, task: m, cu: e{0}.q, pv: 10{2}}}\n"
            "  f{0}: {{type: filter_pt1, task: m, in: c{0}.cv, time_constant: {3} s}}\n",
            i, small_preset(i), reset, small_time_constant);
    }
    return text;
}

/// One of the axes is the shaft. 8,000 is what the loader's 100,000 values admit.
std::string gear_axes(std::size_t axes) {
    std::string text = head() + "  a: {type: virtual_axis, task: m, velocity: 10 mm/s}\n";
    for (std::size_t i = 0; i < axes - 1; ++i)
        text += fmt::format(
            "  s{}: {{type: gear_axis, task: m, master_position: a.position, "
            "master_velocity: a.velocity, ratio: {}}}\n",
            i, 1 + i % 5);
    return text;
}

/// Time of a scan over a thousand scans from the first on.
void run(benchmark::State& state, const std::string& text) {
    Linked program = linked(text);
    const std::vector<std::byte> start = program.machine.memory;
    Quickest quickest;
    for (auto _ : state) {
        std::ranges::copy(start, program.machine.memory.begin());
        Executive executive(program.machine);
        quickest.time([&] { benchmark::DoNotOptimize(executive.run({})); });
    }
    quickest.count(state, scans);
}

std::size_t chains(const benchmark::State& state) {
    return static_cast<std::size_t>(state.range(0)) / 4;
}

void small(benchmark::State& state) {
    run(state, small_blocks(chains(state)));
}

template <class Blocks>
void small_by_hand(benchmark::State& state) {
    Quickest quickest;
    for (auto _ : state) {
        Blocks blocks(chains(state));
        benchmark::DoNotOptimize(&blocks);  // all that they hold may be read
        quickest.time([&] {
            for (std::size_t i = 0; i < scans; ++i) {
                blocks.scan(static_cast<std::int64_t>(i) * small_interval);
                benchmark::ClobberMemory();
            }
        });
    }
    quickest.count(state, scans);
}

void axes(benchmark::State& state) {
    run(state, gear_axes(static_cast<std::size_t>(state.range(0))));
}

/// Reading, checking and wiring a program: time of a block.
void load(benchmark::State& state) {
    const std::string text = small_blocks(chains(state));
    Quickest quickest;
    for (auto _ : state) quickest.time([&] { benchmark::DoNotOptimize(linked(text)); });
    quickest.count(state, static_cast<std::size_t>(state.range(0)));
}

/// Runs the chains by hand beside the program's and looks for the first difference.
template <class Blocks>
class Beside : public Observer {
  public:
    Beside(const Machine& machine, std::size_t chains) : blocks_(chains) {
        for (std::size_t i = 0; i < chains; ++i)
            outs_.push_back(machine.find(fmt::format("f{}.out", i)));
    }

    void scanned(int, const Scan& scan) override {
        blocks_.scan(scan.time);
        for (std::size_t i = 0; i < outs_.size(); ++i)
            if (difference.empty() &&
                bits(std::get<double>(outs_[i]->value())) != bits(blocks_.out(i)))
                difference = fmt::format("'{}' in scan {}", outs_[i]->name, scan.index);
    }
    void settled(std::int64_t, std::int64_t) override {}

    std::string difference;

  private:
    static std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

    Blocks blocks_;
    std::vector<const Signal*> outs_;
};

/// Empty, or where the program and the chains by hand part.
template <class Blocks>
std::string difference() {
    constexpr std::size_t chains = 25;
    Linked program = linked(small_blocks(chains));
    Beside<Blocks> beside(program.machine, chains);
    Executive(program.machine).run({&beside});
    return beside.difference;
}

}  // namespace

BENCHMARK(small)->Arg(100)->Arg(1000);
BENCHMARK(small_by_hand<InlinedSmallBlocks>)->Name("small_inlined")->Arg(100)->Arg(1000);
BENCHMARK(small_by_hand<CalledSmallBlocks>)->Name("small_called")->Arg(100)->Arg(1000);
BENCHMARK(axes)->Arg(10)->Arg(100)->Arg(1000)->Arg(8'000);
BENCHMARK(load)->Arg(1000)->Arg(2000)->Arg(4000);

int main(int count, char** arguments) {
    for (const std::string& where :
         {difference<InlinedSmallBlocks>(), difference<CalledSmallBlocks>()})
        if (!where.empty()) {
            fmt::print(stderr, "the blocks by hand are not the program's: {}\n", where);
            return 1;
        }
    benchmark::Initialize(&count, arguments);
    benchmark::RunSpecifiedBenchmarks();
}

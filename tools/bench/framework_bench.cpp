#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/run/link.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/scan/executive.hpp"
#include "tests/source_folder.hpp"
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

Loaded loaded(const std::filesystem::path& file) {
    Diagnostics problems;
    auto program = load_program(file, {}, standard_blocks(), problems);
    if (!program) throw std::runtime_error(problems.render());
    return std::move(*program);
}

std::string head(const std::string& jitter = {}) {
    return fmt::format(
        "lineshaft: 1\ntasks: {{m: {{every: {} ns{}}}}}\nrun: {{for: {} ns}}\nblocks:\n",
        small_interval, jitter, static_cast<std::int64_t>(scans - 1) * small_interval);
}

constexpr const char* jittered = ", jitter: 50 us";

/// The program of hand_small_blocks.hpp, chain by chain; irregular: kind by kind.
std::string small_blocks(SmallWiring wiring, std::size_t chains, const std::string& jitter = {}) {
    std::string timers, edges, counters, filters, all;
    const auto sources = small_sources(wiring, chains);
    for (std::size_t i = 0; i < chains; ++i) {
        const SmallSources& from = sources[i];
        const std::string in =
            from.timer < 0 ? fmt::format("previous(t{}.q)", i) : fmt::format("e{}.q", from.timer);
        const std::string reset = from.reset < 0 ? "" : fmt::format(", r: e{}.q", from.reset);
        timers += fmt::format("  t{}: {{type: ton, task: m, in: NOT {}, pt: {} ns}}\n", i, in,
                              small_preset(wiring, i));
        edges += fmt::format("  e{}: {{type: r_trig, task: m, clk: t{}.q}}\n", i, from.edge);
        counters += fmt::format("  c{}: {{type: ctu, task: m, cu: e{}.q, pv: 10{}}}\n", i,
                                from.counter, reset);
        filters +=
            fmt::format("  f{}: {{type: filter_pt1, task: m, in: c{}.cv, time_constant: {} s}}\n",
                        i, from.filter, small_time_constant);
        if (wiring == SmallWiring::irregular) continue;
        all += timers + edges + counters + filters;
        for (std::string* part : {&timers, &edges, &counters, &filters}) part->clear();
    }
    return head(jitter) + all + timers + edges + counters + filters;
}

/// Filters in series behind a count, with one time constant or each with its own.
std::string filter_chain(bool own, const std::string& jitter) {
    std::string text = head(jitter) +
                       "  t: {type: ton, task: m, in: NOT previous(t.q), pt: 3 ms}\n"
                       "  c: {type: ctu, task: m, cu: t.q, pv: 10}\n";
    for (int i = 0; i < 100; ++i)
        text +=
            fmt::format("  f{}: {{type: filter_pt1, task: m, in: {}, time_constant: {} us}}\n", i,
                        i == 0 ? "c.cv" : fmt::format("f{}.out", i - 1), 5000 + (own ? i : 0));
    return text;
}

/// Axes that move through the whole run, each by a command of its own, which is given once by one
/// of the blocks that have a thousand axes each, at most. 8,000 is what the loader's 100,000 values
/// admit.
void write_moving_axes(const std::filesystem::path& folder, std::size_t axes,
                       std::string_view limits) {
    const std::size_t together = std::min<std::size_t>(axes, 1000);
    std::ofstream(folder / "start.st") << fmt::format(
        "FUNCTION_BLOCK Start\n"
        "VAR_IN_OUT axes : ARRAY[0..{0}] OF AXIS_REF; END_VAR\n"
        "VAR moves : ARRAY[0..{0}] OF MC_MoveRelative; i : DINT; END_VAR\n"
        "FOR i := 0 TO {0} DO\n"
        "  moves[i](Axis := axes[i], Execute := TRUE, Distance := 1000.0 + DINT_TO_LREAL(i));\n"
        "END_FOR;\n"
        "END_FUNCTION_BLOCK\n",
        together - 1);
    std::string text = fmt::format(
        "lineshaft: 1\nsources: start.st\ntasks: {{m: {{every: 1 ms}}, once: {{every: 1 h}}}}\n"
        "run: {{for: {} ms}}\nblocks:\n",
        scans - 1);
    for (std::size_t i = 0; i < axes; ++i)
        text += fmt::format("  s{}: {{type: axis, task: m{}}}\n", i, limits);
    for (std::size_t i = 0; i < axes; ++i) {
        if (i % together == 0)
            text += fmt::format("  start{}:\n    type: Start\n    task: once\n", i);
        text += fmt::format("    axes[{}]: s{}\n", i % together, i);
    }
    std::ofstream(folder / "axes.yaml") << text;
}

/// Time of a task's scan, from the first on.
void run(benchmark::State& state, Machine& machine) {
    const BlockMemory start = machine.memory;
    Quickest quickest;
    RunResult result;
    for (auto _ : state) {
        std::ranges::copy(start, machine.memory.begin());
        Executive executive(machine);
        quickest.time([&] { benchmark::DoNotOptimize(result = executive.run({})); });
    }
    const std::int64_t all = std::accumulate(result.scans.begin(), result.scans.end(), 0L);
    quickest.count(state, static_cast<std::size_t>(all));
}

void run(benchmark::State& state, const std::string& text) {
    Linked program = linked(text);
    run(state, program.machine);
}

std::size_t chains(const benchmark::State& state) {
    return static_cast<std::size_t>(state.range(0)) / 4;
}

void small(benchmark::State& state, SmallWiring wiring, const char* with_jitter) {
    run(state, small_blocks(wiring, chains(state), with_jitter));
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

void filters(benchmark::State& state, bool own, const char* with_jitter) {
    run(state, filter_chain(own, with_jitter));
}

/// The course's machine, whose logic is serial; or its tasks alone, with nothing to call: the fixed
/// cost of a scan.
void machine_logic(benchmark::State& state, bool empty) {
    Loaded program = loaded(test::in_source("programs/06_machine_logic.yaml"));
    Machine& machine = program.linked.machine;
    if (empty)
        for (Task& task : machine.tasks) task.calls.clear();
    run(state, machine);
}

void axes(benchmark::State& state, std::string_view limits) {
    const auto folder = std::filesystem::temp_directory_path() / "lineshaft_framework_bench";
    std::filesystem::create_directories(folder);
    write_moving_axes(folder, static_cast<std::size_t>(state.range(0)), limits);
    Loaded program = loaded(folder / "axes.yaml");
    run(state, program.linked.machine);
    std::filesystem::remove_all(folder);
}

/// Reading, checking and wiring a program: time of a block.
void load(benchmark::State& state) {
    const std::string text = small_blocks(SmallWiring::batched, chains(state));
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
std::string difference(SmallWiring wiring) {
    constexpr std::size_t chains = 25;
    Linked program = linked(small_blocks(wiring, chains));
    Beside<Blocks> beside(program.machine, chains);
    Executive(program.machine).run({&beside});
    return beside.difference;
}

std::string difference() {
    using enum SmallWiring;
    for (const std::string& where :
         {difference<InlinedSmallBlocks<batched>>(batched),
          difference<CalledSmallBlocks<batched>>(batched),
          difference<CalledSmallBlocks<irregular>>(irregular),
          difference<InlinedSmallBlocks<serial>>(serial),
          difference<CalledSmallBlocks<serial>>(serial),
          difference<CalledSmallBlocks<serial, CatalogueBlocks>>(serial)})
        if (!where.empty()) return where;
    return {};
}

}  // namespace

BENCHMARK_CAPTURE(small, batched, SmallWiring::batched, "")->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(small, irregular, SmallWiring::irregular, "")->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(small, serial, SmallWiring::serial, "")->Arg(4)->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(small, batched_jittered, SmallWiring::batched, jittered)->Arg(100);
BENCHMARK_CAPTURE(small, serial_jittered, SmallWiring::serial, jittered)->Arg(100);
BENCHMARK_CAPTURE(filters, even, false, "");
BENCHMARK_CAPTURE(filters, jittered, false, jittered);
BENCHMARK_CAPTURE(filters, even_own_constants, true, "");
BENCHMARK_CAPTURE(filters, jittered_own_constants, true, jittered);
BENCHMARK_CAPTURE(machine_logic, whole, false);
BENCHMARK_CAPTURE(machine_logic, empty, true);
BENCHMARK(small_by_hand<InlinedSmallBlocks<SmallWiring::batched>>)
    ->Name("inlined/batched")
    ->Arg(100)
    ->Arg(1000);
BENCHMARK(small_by_hand<CalledSmallBlocks<SmallWiring::batched>>)
    ->Name("called/batched")
    ->Arg(100)
    ->Arg(1000);
BENCHMARK(small_by_hand<CalledSmallBlocks<SmallWiring::irregular>>)
    ->Name("called/irregular")
    ->Arg(100)
    ->Arg(1000);
BENCHMARK(small_by_hand<InlinedSmallBlocks<SmallWiring::serial>>)
    ->Name("inlined/serial")
    ->Arg(4)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK(small_by_hand<CalledSmallBlocks<SmallWiring::serial>>)
    ->Name("called/serial")
    ->Arg(4)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK(small_by_hand<CalledSmallBlocks<SmallWiring::serial, CatalogueBlocks>>)
    ->Name("called_of_the_catalogue/serial")
    ->Arg(4)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK_CAPTURE(axes, without_limits, "")->Arg(10)->Arg(100)->Arg(1000)->Arg(8'000);
BENCHMARK_CAPTURE(axes, within_limits,
                  ", software_limits: true, lowest_position: 0 mm, highest_position: 3 m")
    ->Arg(10);
BENCHMARK(load)->Arg(1000)->Arg(2000)->Arg(4000);

int main(int count, char** arguments) {
    if (const std::string where = difference(); !where.empty()) {
        fmt::print(stderr, "the blocks by hand are not the program's: {}\n", where);
        return 1;
    }
    benchmark::Initialize(&count, arguments);
    benchmark::RunSpecifiedBenchmarks();
}

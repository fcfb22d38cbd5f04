#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/model/random.hpp"
#include "runtime/run/single_run.hpp"
#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr std::int64_t ms = 1'000'000;

std::optional<Loaded> load(const std::string& program) {
    static const Catalog catalog = standard_blocks();
    const Folder folder;
    const std::string path = folder / "program.yaml";
    std::ofstream(path) << program;
    Diagnostics diagnostics;
    auto loaded = load_program(path, {.settings = {}, .include_dirs = {}}, catalog, diagnostics);
    INFO(diagnostics.render());
    REQUIRE(loaded);
    return loaded;
}

std::int64_t number(const Loaded& loaded, const std::string& signal) {
    return std::get<std::int64_t>(loaded.linked.machine.find(signal)->value());
}

/// Trains of one length, longer than three scans, each begun when the one before has long ended or
/// queued behind it.
struct Trains {
    std::int64_t interval = 0, cost = 0;  ///< of the task [us]
    std::int64_t rate = 0, count = 0;     ///< [Hz], pulses
    std::string update;
    bool queued = false;

    double duration() const { return static_cast<double>(count) / static_cast<double>(rate); }
};

Trains any_trains(Random& random) {
    const auto pick = [&](const std::vector<std::int64_t>& of) {
        return of[random.next() % of.size()];
    };
    Trains trains;
    trains.interval = pick({100, 500, 1000, 2000, 3000, 7000, 10'000, 333});
    trains.cost = pick({0, 0, 1, trains.interval / 3});
    trains.rate = pick({100, 250, 1000, 1000, 2000, 10'000, 65'535, 999});
    const auto three_scans = static_cast<std::int64_t>(
        std::ceil(3e-6 * static_cast<double>(trains.interval * trains.rate)));
    trains.count = std::max<std::int64_t>(1, three_scans) + pick({1, 2, 7, 10, 50});
    trains.update = random.next() % 2 == 0 ? "continuous" : "per_pulse";
    trains.queued = random.next() % 2 == 0;
    return trains;
}

std::string describe(const Trains& t) {
    return fmt::format("main every {} us, cost {} us, {} pulses at {} Hz, {}{}", t.interval, t.cost,
                       t.count, t.rate, t.update, t.queued ? ", queued" : "");
}

constexpr std::int64_t trains_in_all = 4;

/// The channel between two counters, all in `main`, and an event task.
std::string program_of(const Trains& t, const std::string& run) {
    std::string stimuli;
    for (std::int64_t k = 0; k < trains_in_all; ++k) {
        const double pause = t.queued ? 1 : 2;
        const double at = 1e-2 + static_cast<double>(k) * pause * (t.duration() + 1e-7);
        stimuli += fmt::format("  - {{at: {:.9f} s, set: {{inputs.job: {}}}}}\n", at, k + 1);
    }
    return fmt::format(R"(lineshaft: 1
title: Trains
tasks:
  main: {{every: {} us, cost: {} us}}
  interrupt: {{on: x.done, priority: 20}}
blocks:
  before: {{type: ctu, task: main, cu: previous(x.done), pv: 1}}
  x: {{type: pto, task: main, start_rate: {} Hz, count: {}, rate_update: {}, job: inputs.job}}
  after: {{type: ctu, task: main, cu: x.done, pv: 1}}
inputs: {{job: 0}}
stimulus:
{}run: {}
)",
                       t.interval, t.cost, t.rate, t.count, t.update, stimuli, run);
}

std::int64_t scans_of(const Loaded& loaded, const RunReport& report, std::string_view task) {
    const auto& tasks = loaded.linked.machine.tasks;
    return report.result.scans[static_cast<std::size_t>(
        std::ranges::find(tasks, task, &Task::name) - tasks.begin())];
}

/// Counts the scans of `main` after which `x.done` is true, by train.
struct Rows : Observer {
    explicit Rows(const Machine& machine)
        : done(*machine.find("x.done")), trains(*machine.find("x.trains")) {}

    void scanned(int task, const Scan&) override {
        const auto train = static_cast<std::size_t>(std::get<std::int64_t>(trains.value()));
        if (task == done.task && std::get<bool>(done.value())) ++rows[train];
    }
    void settled(std::int64_t, std::int64_t) override {}

    const Signal &done, &trains;
    std::array<int, trains_in_all + 1> rows{};
};

}  // namespace

TEST_CASE("the end of a train is seen by blocks, traces and event tasks, wherever it falls") {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed, "trains");
        const Trains trains = any_trains(random);
        INFO("seed " << seed << ": " << describe(trains));
        const double end = 0.1 + 2.5 * trains_in_all * trains.duration();
        auto loaded = load(program_of(trains, fmt::format("{{for: {:.9f} s}}", end)));
        Rows rows(loaded->linked.machine);
        const RunReport report =
            run(*loaded, {.trace_path = {}, .progress = {}, .observer = &rows});
        REQUIRE(report.result.outcome == Outcome::completed);
        const std::int64_t ended = number(*loaded, "x.trains");
        CHECK(ended + number(*loaded, "x.refused") == trains_in_all);
        CHECK(number(*loaded, "before.cv") == ended);
        CHECK(number(*loaded, "after.cv") == ended);
        CHECK(scans_of(*loaded, report, "interrupt") == ended);
        for (std::int64_t k = 1; k <= ended; ++k) {
            const int seen = rows.rows[static_cast<std::size_t>(k)];
            CHECK(seen >= 1);
            if (trains.cost == 0) CHECK(seen == 1);
        }
    }
}

TEST_CASE("a run until a train has ended ends with the train") {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Random random(seed, "until");
        const Trains trains = any_trains(random);
        INFO("seed " << seed << ": " << describe(trains));
        auto loaded = load(program_of(trains, "{until: x.done, for: 3 s}"));
        const RunReport report = run(*loaded, {});
        CHECK(report.result.outcome == Outcome::completed);
        const double end = as_real(loaded->linked.machine.find("x.end_time")->value());
        CHECK(seconds(report.result.time) == end);
        CHECK(number(*loaded, "x.trains") == 1);
    }
}

TEST_CASE("a train that is stopped has an end time, and the run an end") {
    auto loaded = load(R"(lineshaft: 1
title: Stop
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: pto, task: main, start_rate: 1 kHz, count: 100, execute: true, stop: inputs.stop}
inputs: {stop: false}
stimulus: [{at: 20.5 ms, set: {inputs.stop: true}}]
run: {until: x.done, for: 3 s}
)");
    const RunReport report = run(*loaded, {});
    CHECK(report.result.outcome == Outcome::completed);
    CHECK(report.result.time == 21 * ms);
    CHECK(as_real(loaded->linked.machine.find("x.end_time")->value()) == 0.021);
    CHECK(as_real(loaded->linked.machine.find("x.stopped")->value()) == 1);
    CHECK(number(*loaded, "x.lost") == 100 - 22);
}

TEST_CASE("what a pulse output clamps or refuses is an event, and a warning at the end") {
    auto loaded = load(R"(lineshaft: 1
title: Out of range
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: pto, task: main, start_rate: 1 kHz, count: inputs.count, job: inputs.job,
      multi_segment: inputs.multi, segments: inputs.segments}
  y: {type: pto, task: main, start_rate: 1 kHz, count: 5, execute: true}
inputs: {count: 10, job: 0, multi: false, segments: 1}
stimulus:
  - {at: 1 ms, set: {inputs.count: 0, inputs.job: 1}}
  - {at: 1.1 s, set: {inputs.count: -5, inputs.job: 2}}
  - {at: 1.2 s, set: {inputs.count: 5, inputs.multi: true, inputs.segments: 0, inputs.job: 3}}
run: {for: 2 s}
trace: {task: main, every: 1000, signals: [x.pulses]}
)");
    const Folder folder;
    const RunReport report =
        run(*loaded, {.trace_path = folder / "t.csv", .interrupt = {}, .progress = {}});
    CHECK(report.result.outcome == Outcome::completed);
    CHECK(report.warnings ==
          std::vector<std::string>{
              "block 'x' (pto) warned 3 times, first of count_out_of_range at 0.001 s"});
    const std::string events = read(folder / "t.events.csv");
    for (const char* line :
         {"0.001,1,main,block_warning,block 'x' (pto) warns of count_out_of_range\n",
          "1.1,1100,main,block_warning,block 'x' (pto) warns of count_out_of_range\n",
          "1.2,1200,main,block_warning,block 'x' (pto) warns of no_segments\n"})
        CHECK_THAT(events, Catch::Contains(line));
}

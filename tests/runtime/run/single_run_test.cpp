#include "runtime/run/single_run.hpp"

#include <atomic>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr const char* program = R"(lineshaft: 1
title: One axis
parameters: {speed: 10 mm/s, acceleration: 100 mm/s^2}
tasks: {main: {every: 10 ms}}
blocks:
  axis: {type: axis, task: main}
  feed:
    type: MC_MoveVelocity
    task: main
    Axis: axis
    Velocity: $speed
    Execute: true
  again:
    type: MC_MoveVelocity
    task: main
    Axis: axis
    Velocity: $speed
    Acceleration: inputs.limit
    Execute: inputs.again
inputs: {limit: 100 mm/s^2, again: false}
stimulus:
  - {at: 0.5 s, set: {inputs.limit: $acceleration, inputs.again: true}}
run: {for: 1 s}
trace: {task: main, every: 50, signals: [axis.velocity, feed.Busy]}
expect:
  - {at: end, axis.velocity: 10 mm/s}
)";

class File {
  public:
    explicit File(const std::string& text = program) : path(folder / "program.yaml") {
        std::ofstream(path) << text;
    }

    std::optional<Loaded> load(const std::vector<Setting>& settings = {}) {
        return load_program(path, {.settings = settings, .include_dirs = {}}, catalog, diagnostics);
    }

    const Catalog catalog = standard_blocks();
    Diagnostics diagnostics;
    Folder folder;
    const std::string path;
};

}  // namespace

TEST_CASE("a program runs to its end and its expectations are judged") {
    File file;
    auto loaded = file.load();
    REQUIRE(loaded);
    const RunReport report = run(*loaded, {});
    CHECK(report.result.outcome == Outcome::completed);
    CHECK(report.result.scans == std::vector<std::int64_t>{101});
    CHECK(report.expectations_hold());
    CHECK_FALSE(report.faulted());
    CHECK(as_real(loaded->linked.machine.find("axis.velocity")->value()) == 10);
}

TEST_CASE("a setting changes the run, and the verdict with it") {
    File file;
    auto loaded = file.load({{.name = "speed", .value = "20 mm/s"}});
    REQUIRE(loaded);
    const RunReport report = run(*loaded, {});
    CHECK_FALSE(report.expectations_hold());
    CHECK_FALSE(report.faulted());
    CHECK(report.verdicts[0].deviation ==
          "axis.velocity is 20 mm/s at 1 s, scan 100; expected 10 mm/s");
}

TEST_CASE("a trace is written while the program runs") {
    File file;
    auto loaded = file.load();
    REQUIRE(loaded);
    const std::string trace = file.folder / "t.csv";
    const RunReport report = run(*loaded, {.trace_path = trace, .interrupt = {}, .progress = {}});
    CHECK(report.output_error.empty());
    CHECK(read(trace) ==
          "time,scan,axis.velocity,feed.Busy\n"
          "0,0,0,1\n"
          "0.5,50,10,1\n"
          "1,100,10,0\n");
    CHECK(std::filesystem::exists(trace + "-metadata.json"));
}

TEST_CASE("a trace that cannot be written is a fault and ends the run") {
    File file;
    auto loaded = file.load();
    REQUIRE(loaded);
    const RunReport report =
        run(*loaded, {.trace_path = file.folder / "none/t.csv", .interrupt = {}, .progress = {}});
    CHECK(report.result.message == "the run stopped at 0 s");
    CHECK(report.faulted());
    CHECK_THAT(report.output_error, Catch::EndsWith("No such file or directory"));
}

TEST_CASE("a block's error is a fault, and what was traced until then is kept") {
    File file;
    auto loaded = file.load({{.name = "acceleration", .value = "0 mm/s^2"}});
    REQUIRE(loaded);
    const std::string trace = file.folder / "t.csv";
    const RunReport report = run(*loaded, {.trace_path = trace, .interrupt = {}, .progress = {}});
    CHECK(report.result.outcome == Outcome::block_error);
    CHECK(report.faulted());
    CHECK(report.result.message ==
          "block 'again' (MC_MoveVelocity) reports error 3 (limit_not_positive) in scan 51 of task "
          "'main' at 0.51 s: velocity, acceleration, deceleration or jerk is not above 0");
    CHECK(read(trace) == "time,scan,axis.velocity,feed.Busy\n0,0,0,1\n0.5,50,10,1\n");
}

TEST_CASE("an interrupted run stops before its end, and its trace says so") {
    File file;
    auto loaded = file.load();
    REQUIRE(loaded);
    const std::atomic<bool> interrupt = true;
    const std::string trace = file.folder / "t.csv";
    const RunReport report =
        run(*loaded, {.trace_path = trace, .interrupt = &interrupt, .progress = {}});
    CHECK(report.result.outcome == Outcome::interrupted);
    CHECK(report.result.time < 1'000'000'000);
    CHECK(read(trace) == "time,scan,axis.velocity,feed.Busy\n0,0,0,1\n");
    CHECK_THAT(read(trace + "-metadata.json"),
               Catch::Contains(R"("lineshaft:stopped": "interrupted at 0 s")"));
}

TEST_CASE("what could not begin to be driven leaves the trace of the run before as it is") {
    File file;
    const std::string trace = file.folder / "t.csv";
    RunOptions options{.trace_path = trace, .interrupt = {}, .progress = {}};
    auto first = file.load();
    REQUIRE(first);
    run(*first, options);
    const std::string before = read(trace), sidecar = read(trace + "-metadata.json");
    auto second = file.load();
    options.drive = [](Executive&, const auto&) { return false; };
    const RunReport report = run(*second, options);
    CHECK(report.traces.empty());
    CHECK(read(trace) == before);
    CHECK(read(trace + "-metadata.json") == sidecar);
}

TEST_CASE("a program with mistakes is not loaded") {
    File wrong("lineshaft: 1\ntasks: {main: {every: 1}}\nblocks: {}\nrun: {for: 1 s}\n");
    CHECK_FALSE(wrong.load());
    CHECK_FALSE(wrong.diagnostics.empty());
    File missing;
    std::filesystem::remove(missing.path);
    CHECK_FALSE(missing.load());
    REQUIRE_FALSE(missing.diagnostics.empty());
    CHECK(missing.diagnostics.list().front().code == "L0001");
}

TEST_CASE("errors that a run goes on after stand in its report, with their reason") {
    File file(R"(lineshaft: 1
tasks: {main: {every: 1 ms}}
blocks:
  m: {type: axis, task: main}
  s: {type: axis, task: main, default_velocity: 40 mm/s}
  feed: {type: MC_MoveVelocity, task: main, Axis: m, Velocity: 50 mm/s, Execute: true}
  gear: {type: MC_GearInPos, task: main, Master: m, Slave: s, MasterSyncPosition: 200 mm, SlaveSyncPosition: 100 mm,
         Execute: inputs.go}
inputs: {go: false}
stimulus: [{at: 1 s, set: {inputs.go: true}}, {at: 1.1 s, set: {inputs.go: false}}, {at: 1.2 s, set: {inputs.go: true}}]
run: {for: 2 s, on_error: continue}
)");
    auto loaded = file.load();
    REQUIRE(loaded);
    const RunReport report = run(*loaded, {});
    CHECK_FALSE(report.faulted());
    REQUIRE(report.warnings.size() == 1);
    CHECK(
        report.warnings[0] ==
        "block 'gear' (MC_GearInPos) reports error 15 (sync_limits) in scan 1001 of task 'main' "
        "at 1.001 s: the coupling takes a velocity of 50 mm/s, and 40 mm/s is the limit (the first "
        "of 2)");
}

TEST_CASE("a profile that does not fit says which of its values it is, and what is due") {
    const auto said = [](const std::string& table, const char* jerk) {
        File file(fmt::format(R"(lineshaft: 1
tasks: {{main: {{every: 1 ms}}}}
blocks:
  x: {{type: axis, task: main, default_jerk: {} mm/s^3}}
  t: {{type: cam_table, task: main, unit: mm/s, master_unit: s, points: {}}}
  p: {{type: MC_VelocityProfile, task: main, Axis: x, TimeVelocity: t, Execute: true}}
run: {{for: 2 s, on_error: continue}}
)",
                              jerk, table));
        auto loaded = file.load();
        REQUIRE(loaded);
        const RunReport report = run(*loaded, {});
        const std::string text = report.warnings.empty() ? "" : report.warnings[0];
        const auto colon = text.find(": ");
        return colon == text.npos ? text : text.substr(colon + 2);
    };
    CHECK(said("[[0 s, 5 mm/s], [1 s, 10 mm/s]]", "5000") ==
          "the profile begins or ends with the velocity 5 mm/s, where 0 mm/s is due");
    CHECK(said("[[0 s, 0 mm/s], [1 s, 10 mm/s]]", "5000") ==
          "the profile begins or ends with the acceleration 10 mm/s^2, where 0 mm/s^2 is due");
    CHECK(said("[[0 s, 0 mm/s], [1 s, 10 mm/s]]", "0").empty());
}

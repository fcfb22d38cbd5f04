#include <catch2/catch.hpp>

#include "tests/runtime/scan/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using Times = std::vector<std::int64_t>;

/// A fast and a slow task, and a time-error task of both.
struct Line : Bench {
    Line()
        : Bench({{.name = "ob80", .priority = 30, .on_event = true},
                 {.name = "fast", .every = 2, .priority = 9, .cost = 1},
                 {.name = "main", .every = 100, .cost = 10}}) {
        machine.main_task = index("main");
        machine.duration = 400 * ms;
        task("main").maximum_cycle_time = 50 * ms;
        for (const char* name : {"fast", "main"}) task(name).on_overrun = index("ob80");
    }
    /// The scan takes `share` hundredths of `limit` [ms].
    void stretch(const std::string& name, std::int64_t scan, std::int64_t limit,
                 std::int64_t share) {
        task(name).costs.push_back({scan, limit * share * ms / 100});
    }
};

struct Events : EventSink {
    void happened(const RunEvent& event) override { list.push_back(event); }
    std::vector<RunEvent> list;
};

}  // namespace

TEST_CASE("without overrun the time-error task never runs", "[overrun]") {
    Line line;
    CHECK(line.run().outcome == Outcome::completed);
    CHECK(line.times("ob80").empty());
    CHECK(line.times("main") == Times{1, 101, 201, 301});
}

TEST_CASE("a slow task at its limit is in time, at 1.01 times it is a time error", "[overrun]") {
    // Alone, so that the cycle has no interruptions in it.
    Line line;
    line.task("fast").offset = 1000 * ms;
    line.stretch("main", 1, 50, 100);
    CHECK(line.run().time_errors == 0);
    Line late;
    late.task("fast").offset = 1000 * ms;
    late.stretch("main", 1, 50, 101);
    const RunResult result = late.run();
    CHECK(result.outcome == Outcome::completed);
    CHECK(result.time_errors == 1);
    CHECK(late.times("ob80") == Times{150});
    CHECK(late.times("main") == Times{0, 100, 200, 300, 400});
}

TEST_CASE("interruptions count into the cycle time", "[overrun]") {
    Line line;
    line.stretch("main", 1, 30, 100);  // 30 ms of 2 ms in which the fast task takes 1
    const RunResult result = line.run();
    CHECK(result.time_errors == 1);
    CHECK(line.times("ob80") == Times{151});
}

TEST_CASE("a slow task at 2.01 times its limit stops the machine", "[overrun]") {
    Line line;
    line.task("fast").offset = 1000 * ms;
    line.stretch("main", 1, 50, 201);
    line.task("main").infos = {{.block = "'x' (probe)", .cost = 0}};
    const RunResult result = line.run();
    CHECK(result.outcome == Outcome::overrun);
    CHECK(result.time == 200 * ms);
    CHECK(line.times("ob80") == Times{150});
    CHECK(result.message ==
          "task 'main' overran: scan 1, begun at 0.1 s, has not ended at 0.2 s; its maximum cycle "
          "time is 0.05 s; block 'x' (probe) was running; STOP: it is the second time error in one "
          "cycle");
}

TEST_CASE("a fast task at 1.01 times its interval loses a release", "[overrun]") {
    Line line;
    line.stretch("fast", 3, 2, 101);
    const RunResult result = line.run();
    CHECK(result.outcome == Outcome::completed);
    CHECK(result.time_errors == 1);
    CHECK(line.times("ob80") == Times{8});
    const Times times = line.times("fast");
    CHECK(Times(times.begin(), times.begin() + 6) == Times{0, 2, 4, 6, 10, 12});
}

TEST_CASE("a fast task at 2.01 times its interval stops the machine", "[overrun]") {
    Line line;
    line.stretch("fast", 3, 2, 201);
    const RunResult result = line.run();
    CHECK(result.outcome == Outcome::overrun);
    CHECK(result.time == 10 * ms);
    CHECK(line.times("ob80") == Times{8});
}

TEST_CASE("two time errors stop the machine in one cycle, and not in two", "[overrun]") {
    Line one;
    one.stretch("fast", 3, 2, 101);
    one.stretch("fast", 6, 2, 101);
    const RunResult stopped = one.run();
    CHECK(stopped.outcome == Outcome::overrun);
    CHECK(stopped.time == 16 * ms);
    CHECK(one.times("ob80") == Times{8});
    Line two;
    two.stretch("fast", 3, 2, 101);
    two.stretch("fast", 70, 2, 101);
    const RunResult result = two.run();
    CHECK(result.outcome == Outcome::completed);
    CHECK(two.times("ob80").size() == 2);
}

TEST_CASE("a motion task, or one without a time-error task, stops at its first overrun",
          "[overrun]") {
    Line motion;
    motion.task("fast").motion = true;
    motion.stretch("fast", 3, 2, 101);
    const RunResult result = motion.run();
    CHECK(result.outcome == Outcome::overrun);
    CHECK(result.time == 8 * ms);
    CHECK(motion.times("ob80").empty());
    CHECK_THAT(result.message, Catch::EndsWith("STOP: a motion task must not overrun"));
    Line bare;
    bare.task("fast").on_overrun = -1;
    bare.stretch("fast", 3, 2, 101);
    CHECK(bare.run().time == 8 * ms);
}

TEST_CASE("the block that was running is found by the blocks' costs", "[overrun]") {
    Line line;
    line.task("fast").cost = 2 * ms;
    // 0.5 ms each of the task's own, and 1 ms of b: a runs for the first quarter of the time.
    line.task("fast").infos = {{"'a' (probe)", 0}, {"'b' (probe)", 1 * ms}};
    line.task("fast").on_overrun = -1;
    line.stretch("fast", 0, 2, 150);
    CHECK_THAT(line.run().message, Catch::Contains("block 'b' (probe) was running"));
    Line early;
    early.task("fast").infos = {{"'a' (probe)", 0}, {"'b' (probe)", 1 * ms}};
    early.task("fast").cost = 2 * ms;
    early.task("fast").on_overrun = -1;
    early.stretch("fast", 0, 2, 500);
    CHECK_THAT(early.run().message, Catch::Contains("block 'a' (probe) was running"));
    Line first;
    first.task("fast").infos = {{"'a' (probe)", 1 * ms}, {"'b' (probe)", 0}};
    first.task("fast").cost = 2 * ms;
    first.task("fast").on_overrun = -1;
    first.stretch("fast", 0, 2, 150);
    CHECK_THAT(first.run().message, Catch::Contains("block 'a' (probe) was running"));
}

TEST_CASE("time errors and STOP are told with task and scan", "[overrun]") {
    Line line;
    line.stretch("fast", 3, 2, 201);
    Events events;
    Executive executive(line.machine);
    executive.report_to(events);
    executive.run({});
    std::vector<EventKind> kinds;
    for (const RunEvent& e : events.list) kinds.push_back(e.kind);
    CHECK(kinds == std::vector{EventKind::stimulus, EventKind::overrun, EventKind::overrun,
                               EventKind::stop});
    for (const RunEvent& e : events.list) {
        CHECK(e.task == line.index("fast"));
        CHECK(e.scan == 3);
    }
    CHECK(events.list.back().time == 10 * ms);
}

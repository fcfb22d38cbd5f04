#include "runtime/scan/executive.hpp"

#include <atomic>
#include <set>

#include <catch2/catch.hpp>

#include "tests/allocations.hpp"
#include "tests/runtime/scan/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using Times = std::vector<std::int64_t>;
using Changes = std::vector<Watch::Change>;

Stimulus set_input(Bench& bench, const std::string& task, std::int64_t at, std::int64_t value) {
    return {at * ms, reinterpret_cast<std::byte*>(&bench.live(task).input), Type::integer, value};
}

Times intervals(const Times& times) {
    Times result;
    for (std::size_t i = 1; i < times.size(); ++i) result.push_back(times[i] - times[i - 1]);
    return result;
}

}  // namespace

TEST_CASE("tasks due at one instant run by priority, equal ones in their order") {
    Bench bench({{.name = "low"}, {.name = "high", .priority = 9}, {.name = "other"}});
    bench.machine.duration = 0;
    bench.run();
    CHECK(bench.log == std::vector<Event>{{"high", 0, 0, 0}, {"low", 0, 0, 0}, {"other", 0, 0, 0}});
}

TEST_CASE("a run covers its first and its last instant") {
    Bench bench({{.name = "a", .every = 5}});
    const RunResult result = bench.run();
    CHECK(bench.times("a") == Times{0, 5, 10});
    CHECK(result.outcome == Outcome::completed);
    CHECK(result.time == 10 * ms);
    CHECK(result.scans == Times{3});
    CHECK(result.message.empty());
}

TEST_CASE("an offset moves the first scan") {
    Bench bench({{.name = "a", .every = 4, .offset = 3}, {.name = "b", .every = 4, .offset = 11}});
    const RunResult result = bench.run();
    CHECK(bench.times("a") == Times{3, 7});
    CHECK(bench.times("b").empty());
    CHECK(result.scans[static_cast<std::size_t>(bench.index("b"))] == 0);
}

TEST_CASE("a task without cost is seen by the tasks after it at the same instant") {
    Bench bench({{.name = "fast", .priority = 2}, {.name = "slow"}});
    bench.wire("fast", "slow");
    bench.machine.duration = ms;
    bench.run();
    CHECK(bench.log ==
          std::vector<Event>{
              {"fast", 0, 0, 0}, {"slow", 0, 0, 1}, {"fast", 1, 1, 0}, {"slow", 1, 1, 2}});
}

TEST_CASE("a task with a cost publishes that much after its start") {
    Bench bench({{.name = "a", .every = 5, .cost = 2}});
    Watch watch(bench.output("a"));
    bench.run({&watch});
    CHECK(bench.times("a") == Times{0, 5, 10});
    CHECK(watch.changes == Changes{{2, 1}, {7, 2}});
}

TEST_CASE("a task of higher priority preempts, reads what was published and puts the end off") {
    Bench bench({{.name = "fast", .every = 4, .priority = 2, .offset = 2, .cost = 1},
                 {.name = "slow", .every = 20, .cost = 6}});
    bench.wire("slow", "fast");
    Watch slow(bench.output("slow")), fast(bench.output("fast"));
    bench.machine.duration = 14 * ms;
    bench.run({&slow, &fast});
    // slow has the processor in 0..2, 3..6 and 7..8, fast in 2..3 and 6..7.
    CHECK(slow.changes == Changes{{8, 1}});
    CHECK(fast.changes == Changes{{3, 1}, {7, 2}, {11, 3}});
    CHECK(bench.log == std::vector<Event>{{"slow", 0, 0, 0},
                                          {"fast", 2, 0, 0},
                                          {"fast", 6, 1, 0},
                                          {"fast", 10, 2, 1},
                                          {"fast", 14, 3, 1}});
}

TEST_CASE("tasks of lower or equal priority wait for the end of a scan") {
    Bench bench({{.name = "busy", .every = 20, .priority = 2, .cost = 3},
                 {.name = "equal", .every = 20, .priority = 2, .offset = 1},
                 {.name = "low", .every = 20, .offset = 2}});
    bench.wire("busy", "low");
    bench.run();
    CHECK(bench.log == std::vector<Event>{{"busy", 0, 0, 0}, {"equal", 3, 0, 0}, {"low", 3, 0, 1}});
}

TEST_CASE("preemption nests") {
    Bench bench({{.name = "a", .every = 20, .cost = 4},
                 {.name = "b", .every = 20, .priority = 2, .offset = 1, .cost = 3},
                 {.name = "c", .every = 20, .priority = 3, .offset = 2, .cost = 2}});
    Watch a(bench.output("a")), b(bench.output("b")), c(bench.output("c"));
    bench.run({&a, &b, &c});
    CHECK(c.changes == Changes{{4, 1}});
    CHECK(b.changes == Changes{{6, 1}});
    CHECK(a.changes == Changes{{9, 1}});
}

TEST_CASE("a scan that ends when its task is due again has ended in time") {
    Bench bench({{.name = "a", .every = 2, .cost = 2}});
    Watch watch(bench.output("a"));
    bench.machine.duration = 6 * ms;
    const RunResult result = bench.run({&watch});
    CHECK(result.outcome == Outcome::completed);
    CHECK(bench.times("a") == Times{0, 2, 4, 6});
    CHECK(watch.changes == Changes{{2, 1}, {4, 2}, {6, 3}});
}

TEST_CASE("what ends at an instant is published before tasks due then read it") {
    Bench bench(
        {{.name = "slow", .every = 20, .cost = 4}, {.name = "fast", .every = 4, .priority = 2}});
    bench.wire("slow", "fast");
    bench.machine.duration = 4 * ms;
    bench.run();
    CHECK(bench.log.back() == Event{"fast", 4, 1, 1});
}

TEST_CASE("a task due again before its scan has ended is an overrun") {
    Bench bench({{.name = "main", .every = 2, .cost = 3}});
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::overrun);
    CHECK(result.time == 2 * ms);
    CHECK(result.message ==
          "task 'main' overran: it is due again at 0.002 s, before scan 0, begun at 0 s, has "
          "ended; STOP: "
          "no task has it under 'on_overrun'");
}

TEST_CASE("a task that could not even begin is an overrun, with the time it was due") {
    Bench bench({{.name = "high", .every = 100, .priority = 2, .cost = 50},
                 {.name = "low", .every = 7, .offset = 3, .jitter = 2}});
    bench.machine.duration = 40 * ms;
    Bench undisturbed({{.name = "low", .every = 7, .offset = 3, .jitter = 2}});
    undisturbed.machine.duration = 40 * ms;
    undisturbed.run();
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::overrun);
    CHECK(result.time / ms == undisturbed.times("low")[1]);
    CHECK_THAT(result.message, Catch::Contains("before scan 0, due at 0.003 s, could begin; task "
                                               "'high' was running"));
}

TEST_CASE("jitter draws each interval within its bounds and lets them add up") {
    Bench bench({{.name = "a", .every = 10, .jitter = 3}});
    bench.machine.duration = 20'000 * ms;
    bench.run();
    const Times steps = intervals(bench.times("a"));
    const std::set<std::int64_t> seen(steps.begin(), steps.end());
    // Times are whole milliseconds here, cut from nanoseconds: a step can look 1 ms longer.
    CHECK(*seen.begin() >= 6);
    CHECK(*seen.rbegin() <= 14);
    CHECK(seen.size() >= 7);
    // The sum of n draws of +-3 ms wanders: the scans are not on a grid of 10 ms.
    std::int64_t farthest = 0;
    const Times times = bench.times("a");
    for (std::size_t i = 0; i < times.size(); ++i)
        farthest = std::max(farthest, std::abs(times[i] - 10 * static_cast<std::int64_t>(i)));
    CHECK(farthest > 14);
}

TEST_CASE("one seed gives one sequence of jitter, another seed another") {
    const auto times = [](std::uint64_t seed, const std::string& name) {
        Bench bench({{.name = name, .every = 10, .jitter = 5}});
        bench.machine.seed = seed;
        bench.machine.duration = 1000 * ms;
        bench.run();
        return bench.times(name);
    };
    CHECK(times(7, "a") == times(7, "a"));
    CHECK(times(7, "a") != times(8, "a"));
    CHECK(times(7, "a") != times(7, "b"));
}

TEST_CASE("a block's seed is drawn from the run's and its name, unless it has one") {
    const auto drawn = [](std::uint64_t seed, const std::string& block, std::int64_t given) {
        Bench bench({{.name = "a"}});
        bench.machine.seed = seed;
        bench.machine.duration = 0;
        bench.live("a").input = given;
        bench.machine.block_seeds = {{reinterpret_cast<std::byte*>(&bench.live("a").input), block}};
        bench.run();
        return bench.live("a").input;
    };
    CHECK(drawn(7, "x", 0) > 0);
    CHECK(drawn(7, "x", 0) == drawn(7, "x", 0));
    CHECK(drawn(7, "x", 0) != drawn(8, "x", 0));
    CHECK(drawn(7, "x", 0) != drawn(7, "y", 0));
    CHECK(drawn(7, "x", 5) == 5);
}

TEST_CASE("a cost with jitter wanders about the cost") {
    Bench bench({{.name = "a", .every = 20, .cost = 10, .cost_jitter = 5}});
    bench.machine.duration = 4000 * ms;
    Watch watch(bench.output("a"));
    bench.run({&watch});
    std::set<std::int64_t> seen;
    for (const Watch::Change& c : watch.changes) seen.insert(c.time - (c.value - 1) * 20);
    CHECK(*seen.begin() >= 5);
    CHECK(*seen.rbegin() <= 15);
    CHECK(seen.size() >= 9);
}

TEST_CASE("stimuli are set before the tasks due at the same instant") {
    Bench bench({{.name = "a", .every = 2}});
    bench.machine.stimuli = {set_input(bench, "a", 0, 5), set_input(bench, "a", 3, 6),
                             set_input(bench, "a", 4, 7), set_input(bench, "a", 11, 8)};
    bench.machine.duration = 6 * ms;
    bench.run();
    CHECK(bench.log ==
          std::vector<Event>{{"a", 0, 0, 5}, {"a", 2, 1, 5}, {"a", 4, 2, 7}, {"a", 6, 3, 7}});
}

TEST_CASE("until ends the run at the instant that makes it true") {
    Bench bench({{.name = "a", .every = 2, .cost = 1}});
    bench.live("a").flag_at = 2;
    bench.machine.until = bench.flag("a");
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::completed);
    CHECK(result.time == 5 * ms);
    CHECK(result.message.empty());
}

TEST_CASE("until that does not become true is a limit, at the end of the time") {
    Bench bench({{.name = "a", .every = 2}});
    bench.machine.until = bench.flag("a");
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::limit);
    CHECK(result.time == 10 * ms);
    CHECK(result.message == "'a.flag' did not become true within 0.01 s");
    Bench last({{.name = "a", .every = 2}});
    last.live("a").flag_at = 5;
    last.machine.until = last.flag("a");
    CHECK(last.run().outcome == Outcome::completed);
}

TEST_CASE("a block's error ends the run and names block, scan and time") {
    Bench bench({{.name = "main", .every = 2, .priority = 2}, {.name = "after", .every = 1}});
    bench.live("main").flag_at = 3;
    bench.live("main").reason = 1;
    bench.report_errors("main");
    static constexpr std::string_view names[] = {"none", "not_finite"};
    bench.task("main").errors.front().names = ValueNames(names);
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::block_error);
    CHECK(result.time == 6 * ms);
    CHECK(result.message ==
          "block 'main_block' (probe) reports error 1 (not_finite) in scan 3 of "
          "task 'main' at 0.006 s");
    CHECK(bench.times("after").back() == 5);
}

TEST_CASE("an error stays the outcome when another task overruns at the same instant") {
    Bench bench({{.name = "slow", .every = 20, .priority = 2, .cost = 4},
                 {.name = "low", .every = 2, .offset = 2}});
    bench.live("slow").flag_at = 0;
    bench.report_errors("slow");
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::block_error);
}

TEST_CASE("continue_on_error goes on") {
    Bench bench({{.name = "main", .every = 2}});
    bench.live("main").flag_at = 1;
    bench.report_errors("main");
    bench.machine.continue_on_error = true;
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::completed);
    CHECK(bench.times("main") == Times{0, 2, 4, 6, 8, 10});
}

TEST_CASE("an interrupt ends the run and says when") {
    Bench bench({{.name = "main"}});
    bench.machine.duration = 1'000'000 * ms;
    bench.live("main").log = nullptr;
    const std::atomic<bool> interrupt = true;
    const RunResult result = bench.run({}, &interrupt);
    CHECK(result.outcome == Outcome::interrupted);
    CHECK(result.message == "interrupted at 0 s");
}

TEST_CASE("observers hear of nothing after the end of the run") {
    class Ends : public Observer {
      public:
        void scanned(int, const Scan&) override {}
        void settled(std::int64_t time, std::int64_t next) override {
            last = time;
            steady_until = next;
        }
        std::int64_t last = -1, steady_until = -1;
    };
    Ends ends;
    Bench bench({{.name = "a", .every = 4}});
    bench.run({&ends});
    CHECK(ends.last == 8 * ms);
    CHECK(ends.steady_until == 10 * ms + 1);  // the run covers 10 ms
    Bench until({{.name = "a", .every = 4}});
    until.live("a").flag_at = 1;
    until.machine.until = until.flag("a");
    until.run({&ends});
    CHECK(ends.last == 4 * ms);
    CHECK(ends.steady_until == 4 * ms + 1);
}

TEST_CASE("an event that never comes changes nothing") {
    const auto run = [](bool with_event, std::uint64_t seed) {
        Bench bench({{.name = "a", .every = 3, .priority = 2, .jitter = 1},
                     {.name = "b", .every = 2, .priority = 9, .offset = 1},
                     {.name = "c", .every = 5, .jitter = 2},
                     {.name = "e", .priority = 5, .on_event = true}});
        bench.machine.seed = seed;
        bench.machine.duration = 400 * ms;
        bench.wire("a", "b");
        bench.wire("b", "c");
        bench.wire("c", "a");
        bench.report_errors("c");
        bench.live("c").flag_at = 60;
        bench.task("b").stimuli.push_back(
            {7, reinterpret_cast<std::byte*>(&bench.live("b").wanted), Type::boolean, true});
        if (with_event) bench.trigger("a", "e");
        Watch output(bench.output("b"));
        const RunResult result = bench.run({&output});
        CHECK(result.outcome == Outcome::block_error);
        return std::tuple(bench.log, output.changes, result.scans, result.time, result.message,
                          bench.live("b").wanted);
    };
    for (std::uint64_t seed = 1; seed <= 20; ++seed) CHECK(run(false, seed) == run(true, seed));
}

TEST_CASE("inputs are converted as their wires say") {
    struct Ports {
        bool yes = true, inverted = true;
        std::int64_t three = 3;
        std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
        double of_most = 0;
        double millimetres = 20, real = 0, tenths = 0, centimetres = 0;
    } ports;
    Bench bench({{.name = "a"}});
    const auto at = [](auto& member) { return reinterpret_cast<std::byte*>(&member); };
    Task& task = bench.task("a");
    task.wires = {.copies = {{at(ports.yes), at(bench.live("a").wanted)},
                             {at(ports.yes), at(ports.inverted), true},
                             {at(ports.three), at(bench.live("a").input)},
                             {at(ports.three), at(ports.real)}},
                  .rows = {},
                  .scaled = {{at(ports.three), at(ports.tenths), 1, 10, Type::integer},
                             {at(ports.millimetres), at(ports.centimetres), 1, 10, Type::real},
                             {at(ports.most), at(ports.of_most), 1, 1, Type::unsigned_integer}}};
    Call& call = task.calls.front();
    call.feed = Feed::many;
    call.first_copy = task.wires.copies.data();
    call.first_scaled = task.wires.scaled.data();
    call.words = call.widened = 1;
    call.booleans = 2;
    call.scaled = 3;
    bench.machine.duration = 0;
    bench.run();
    CHECK(bench.live("a").wanted);
    CHECK(ports.of_most == 0x1p64);
    CHECK_FALSE(ports.inverted);
    CHECK(ports.real == 3);
    CHECK(ports.tenths == 0.3);
    CHECK(bench.live("a").input == 3);
    CHECK(ports.centimetres == 2);
}

TEST_CASE("nothing is allocated while cycling") {
    Bench bench({{.name = "slow", .every = 5, .cost = 2, .cost_jitter = 1},
                 {.name = "fast", .every = 1, .priority = 2, .jitter = 0}});
    bench.wire("slow", "fast");
    for (const char* task : {"slow", "fast"}) bench.live(task).log = nullptr;
    bench.machine.stimuli = {set_input(bench, "slow", 7, 1)};
    bench.machine.duration = 10'000 * ms;

    class Counter : public Observer {
      public:
        void scanned(int, const Scan&) override { seen(); }
        void settled(std::int64_t, std::int64_t) override { seen(); }
        void seen() {
            if (first < 0) first = allocations();
            last = allocations();
        }
        std::int64_t first = -1, last = -1;
    };
    Counter counter;
    const RunResult result = bench.run({&counter});
    REQUIRE(result.outcome == Outcome::completed);
    CHECK(counter.last == counter.first);
}

TEST_CASE("a task whose next scan lies beyond all time runs once") {
    Bench bench({{.name = "a", .every = 1, .offset = 0}});
    bench.task("a").every = 9'000'000'000'000'000'000;
    bench.task("a").offset = 9'000'000'000'000'000'000;
    bench.machine.duration = 9'200'000'000'000'000'000;
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::completed);
    CHECK(result.scans == Times{1});
}

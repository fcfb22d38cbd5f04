#include "runtime/scan/forces.hpp"

#include <catch2/catch.hpp>

#include "tests/runtime/scan/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using Changes = std::vector<Watch::Change>;

std::byte* slot(const auto& member) {
    return const_cast<std::byte*>(reinterpret_cast<const std::byte*>(&member));
}

Force force_output(Bench& bench, const std::string& task, std::int64_t from, std::int64_t until,
                   std::int64_t value) {
    const bool split = &bench.published(task) != &bench.live(task);
    return {.from = from * ms,
            .until = until * ms,
            .live = slot(bench.live(task).output),
            .published = split ? slot(bench.published(task).output) : nullptr,
            .block = bench.task(task).live,
            .is_output = true,
            .task = bench.index(task),
            .type = Type::integer,
            .value = value,
            .name = {},
            .value_text = {}};
}

Force force_flag(Bench& bench, const std::string& task, std::int64_t from, std::int64_t until) {
    Force force = force_output(bench, task, from, until, 0);
    force.live = slot(bench.live(task).flag);
    force.type = Type::boolean;
    force.value = true;
    return force;
}

}  // namespace

TEST_CASE("a forced output keeps its value, and the block's own is back after it", "[force]") {
    Bench bench({{.name = "a", .every = 2}});
    bench.machine.forces = {force_output(bench, "a", 3, 7, 100)};
    Watch watch(bench.output("a"));
    bench.run({&watch});
    CHECK(watch.changes == Changes{{0, 1}, {2, 2}, {3, 100}, {7, 4}, {8, 5}, {10, 6}});
}

TEST_CASE("a forced variable of a program stays behind the force until it is written", "[force]") {
    Bench bench({{.name = "a", .every = 2}});
    bench.machine.forces = {force_output(bench, "a", 3, 7, 100)};
    bench.machine.forces[0].stays = true;
    Watch watch(bench.output("a"));
    bench.run({&watch});
    CHECK(watch.changes == Changes{{0, 1}, {2, 2}, {3, 100}, {8, 5}, {10, 6}});
}

TEST_CASE("a forced output is forced where others see it, while a scan takes time", "[force]") {
    Bench bench({{.name = "a", .every = 4, .cost = 1}});
    bench.machine.forces = {force_output(bench, "a", 3, 7, 100)};
    Watch watch(bench.output("a"));
    bench.run({&watch});
    CHECK(watch.changes == Changes{{1, 1}, {3, 100}, {7, 2}, {9, 3}});
}

TEST_CASE("a forced input wins over its wire", "[force]") {
    Bench bench({{.name = "from", .every = 2, .priority = 2}, {.name = "to", .every = 2}});
    bench.wire("from", "to");
    bench.machine.forces = {{.from = 3 * ms,
                             .until = 7 * ms,
                             .live = slot(bench.live("to").input),
                             .block = bench.task("to").live,
                             .task = bench.index("to"),
                             .type = Type::integer,
                             .value = std::int64_t{50},
                             .name = {},
                             .value_text = {}}};
    bench.run();
    std::vector<std::int64_t> read;
    for (const Event& e : bench.log)
        if (e.task == "to") read.push_back(e.input);
    CHECK(read == std::vector<std::int64_t>{1, 2, 50, 50, 5, 6});
}

TEST_CASE("a stimulus during a force counts after it", "[force]") {
    Bench bench({{.name = "a", .every = 1}});
    bench.machine.forces = {{.from = 2 * ms,
                             .until = 5 * ms,
                             .live = slot(bench.live("a").input),
                             .type = Type::integer,
                             .value = std::int64_t{9},
                             .name = {},
                             .value_text = {}}};
    bench.machine.stimuli = {{3 * ms, slot(bench.live("a").input), Type::integer, std::int64_t{4}}};
    bench.machine.duration = 6 * ms;
    bench.run();
    std::vector<std::int64_t> read;
    for (const Event& e : bench.log) read.push_back(e.input);
    CHECK(read == std::vector<std::int64_t>{0, 0, 9, 9, 9, 4, 4});
}

TEST_CASE("a forced signal releases event tasks", "[force]") {
    Bench bench({{.name = "a", .every = 1}, {.name = "event", .priority = 5, .on_event = true}});
    bench.trigger("a", "event");
    bench.machine.forces = {force_flag(bench, "a", 3, 5)};
    bench.run();
    CHECK(bench.times("event") == std::vector<std::int64_t>{3});
}

TEST_CASE("a forced error ends the run like the block's own", "[force]") {
    Bench bench({{.name = "a", .every = 2}});
    bench.report_errors("a");
    bench.machine.forces = {force_flag(bench, "a", 3, 7)};
    const RunResult result = bench.run();
    CHECK(result.outcome == Outcome::block_error);
    CHECK(result.time == 4 * ms);
}

TEST_CASE("a stimulus by scan comes before that scan of its task", "[force]") {
    Bench bench({{.name = "a", .every = 2}});
    bench.task("a").stimuli = {{3, slot(bench.live("a").input), Type::integer, std::int64_t{7}}};
    bench.run();
    CHECK(bench.log[2].input == 0);
    CHECK(bench.log[3] == Event{"a", 6, 3, 7});
}

#include "blocks/motion/state_commands.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "tests/blocks/motion/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr const char* one_way = R"(
tasks: {main: {every: 1 ms}}
blocks:
  m: {type: axis, task: main}
  x: {type: axis, task: main, default_deceleration: 500 mm/s^2}
  power: {type: MC_Power, task: main, Axis: x, Enable: true}
  reset: {type: MC_Reset, task: main, Axis: x}
  there: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 50 mm}
  back: {type: MC_MoveRelative, task: main, Axis: x, Distance: -10 mm}
  velocity: {type: MC_MoveVelocity, task: main, Axis: x, Velocity: -20 mm/s}
  turning: {type: MC_MoveContinuousAbsolute, task: main, Axis: x, Position: 50 mm, EndVelocity: -5 mm/s}
  added: {type: MC_MoveSuperimposed, task: main, Axis: x, Distance: -5 mm}
  search: {type: MC_Home, task: main, Axis: x, HomingMode: mcOnSignal, Direction: mcNegativeDirection}
  halt: {type: MC_Halt, task: main, Axis: x}
  lead: {type: MC_MoveVelocity, task: main, Axis: m, Velocity: -20 mm/s}
  gear: {type: MC_GearIn, task: main, Master: m, Slave: x}
)";

}  // namespace

TEST_CASE("a command whose way goes in a direction that is not enabled is refused") {
    for (const char* command : {"back", "velocity", "turning", "added", "search"}) {
        MotionBench bench(one_way);
        bench.set("power.EnableNegative", false);
        bench.step(3);
        bench.set(fmt::format("{}.Execute", command), true);
        bench.step(5);
        INFO(command);
        CHECK(bench.text(fmt::format("{}.ErrorID", command)) == "direction_not_enabled");
        CHECK(bench.is("power.Status"));
        CHECK(bench.number("x.position") == 0);
        CHECK_FALSE(bench.is("x.error"));
        bench.set("there.Execute", true);
        bench.step(2000);
        CHECK(bench.is("there.Done"));
        bench.set("power.EnableNegative", true);
        bench.set(fmt::format("{}.Execute", command), false);
        bench.step(3);
        bench.set(fmt::format("{}.Execute", command), true);
        bench.step(100);
        CHECK(bench.number("x.position") < 50);
    }
}

TEST_CASE("an axis whose direction is taken away brakes with its own deceleration: ErrorStop") {
    MotionBench bench(one_way);
    bench.set("there.Execute", true);
    bench.step(300);
    CHECK(bench.number("x.velocity") == 100);
    bench.set("power.EnablePositive", false);
    bench.step(3);
    CHECK(bench.text("x.state") == "error_stop");
    CHECK(bench.text("x.error_id") == "direction_not_enabled");
    CHECK(bench.text("there.ErrorID") == "direction_not_enabled");
    const double at = bench.number("x.position");
    bench.step(1000);
    CHECK(bench.number("x.velocity") == 0);
    CHECK(bench.number("x.position") - at == Approx(100.0 * 100 / (2 * 500)).epsilon(0.1));
    bench.set("reset.Execute", true);
    bench.step(3);
    CHECK(bench.text("x.state") == "standstill");
    bench.set("back.Execute", true);
    bench.step(1000);
    CHECK(bench.is("back.Done"));
}

TEST_CASE("a master does not lead its slave in a direction that is not enabled") {
    MotionBench bench(one_way);
    bench.set("power.EnableNegative", false);
    bench.set("gear.Execute", true);
    bench.step(10);
    CHECK(bench.is("gear.InGear"));
    bench.set("lead.Execute", true);
    bench.step(500);
    CHECK(bench.text("x.error_id") == "direction_not_enabled");
    CHECK(bench.number("x.velocity") == 0);
    CHECK(bench.number("x.position") > -0.01);
}

TEST_CASE("a motion that brakes may do so in a direction that is not enabled any more") {
    MotionBench bench(one_way);
    bench.set("there.Execute", true);
    bench.step(300);
    bench.set("halt.Execute", true);
    bench.step(20);
    bench.set("power.EnablePositive", false);
    bench.step(1000);
    CHECK(bench.is("halt.Done"));
    CHECK_FALSE(bench.is("x.error"));
}

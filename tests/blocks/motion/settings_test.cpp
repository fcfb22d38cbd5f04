#include "blocks/motion/settings.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "runtime/model/random.hpp"
#include "tests/blocks/motion/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr const char* turning = R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, unit: deg, modulo: true, period: 360 deg, start_position: 350 deg, default_velocity: 1000 deg/s, default_acceleration: 1e4 deg/s^2, default_deceleration: 1e4 deg/s^2, default_jerk: 1e6 deg/s^3}
  move: {type: MC_MoveAbsolute, task: main, Axis: x}
)";

constexpr const char* straight = R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, software_limits: true, lowest_position: -100 mm, highest_position: 100 mm}
  move: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 50 mm}
  velocity: {type: MC_MoveVelocity, task: main, Axis: x, Velocity: 100 mm/s}
  home: {type: MC_Home, task: main, Axis: x, Velocity: 20 mm/s}
  override: {type: MC_SetOverride, task: main, Axis: x}
  position: {type: MC_SetPosition, task: main, Axis: x, Position: 7 mm}
  switch: {type: MC_WriteBoolParameter, task: main, Axis: x, ParameterNumber: 4}
  reset: {type: MC_Reset, task: main, Axis: x}
  status: {type: MC_ReadStatus, task: main, Axis: x, Enable: true}
)";

/// How far a modulo axis turns from 350 deg to the position.
double way(double to, MoveDirection direction) {
    MotionBench bench(turning);
    bench.set("move.Position", to);
    bench.set("move.Direction", static_cast<std::int64_t>(direction));
    bench.set("move.Execute", true);
    for (int ms = 0; ms < 5000 && !bench.is("move.Done"); ++ms) bench.step();
    REQUIRE(bench.is("move.Done"));
    CHECK(bench.number("x.position") == Approx(to).margin(1e-9));
    return bench.axis("x").total().position - 350;
}

void run_until(MotionBench& bench, std::string_view signal) {
    for (int ms = 0; ms < 20'000 && !bench.is(signal); ++ms) bench.step();
    INFO(signal);
    REQUIRE(bench.is(signal));
}

}  // namespace

TEST_CASE("a modulo axis goes the way that is asked for") {
    CHECK(way(10, MoveDirection::shortest_way) == Approx(20));
    CHECK(way(10, MoveDirection::positive) == Approx(20));
    CHECK(way(10, MoveDirection::negative) == Approx(-340));
    CHECK(way(340, MoveDirection::shortest_way) == Approx(-10));
    CHECK(way(340, MoveDirection::positive) == Approx(350));
    CHECK(way(350, MoveDirection::positive) == Approx(0).margin(1e-9));
    CHECK(way(350, MoveDirection::negative) == Approx(0).margin(1e-9));
}

TEST_CASE("a command is taken up in the scan after its task has published, and seen likewise") {
    MotionBench bench(R"(
tasks:
  servo: {every: 1 ms, priority: 20}
  main: {every: 10 ms, priority: 1, cost: 3 ms}
blocks:
  x: {type: axis, task: servo}
  move: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 10 mm}
)");
    bench.check(R"(
    ms  move.Execute | move.Busy move.Active x.state
    9   1            | 0         0           standstill
    10  .            | 0         0           standstill
    12  .            | 0         0           standstill
    13  .            | 1         0           discrete_motion
    14  .            | 1         0           discrete_motion
    22  .            | 1         0           discrete_motion
    23  .            | 1         1           discrete_motion )");
}

TEST_CASE("an axis that runs into its software limit stops before it, and MC_Reset helps") {
    MotionBench bench(straight);
    bench.set("velocity.Execute", true);
    run_until(bench, "x.error");
    CHECK(bench.is("velocity.Error"));
    bench.step(1000);
    CHECK(bench.number("x.position") <= 100);
    CHECK(bench.number("x.position") > 99.5);
    CHECK(bench.number("x.velocity") == 0);
    CHECK(bench.is("status.ErrorStop"));
    bench.set("reset.Execute", true);
    run_until(bench, "reset.Done");
    CHECK_FALSE(bench.is("x.error"));
    CHECK(bench.is("status.Standstill"));
    bench.set("move.Position", 101.0);
    bench.set("move.Execute", true);
    run_until(bench, "move.Error");
    CHECK_FALSE(bench.is("x.error"));
}

TEST_CASE("an override of 0 holds a move, and lets it go on") {
    MotionBench bench(straight);
    bench.set("override.Enable", true);
    bench.set("move.Execute", true);
    bench.step(200);
    bench.set("override.VelFactor", 0.0);
    bench.step(500);
    CHECK(bench.number("x.velocity") == 0);
    CHECK(bench.is("move.Active"));
    CHECK(bench.is("override.Enabled"));
    bench.set("override.VelFactor", 0.5);
    bench.step(200);
    CHECK(bench.number("x.velocity") == Approx(50));
    run_until(bench, "move.Done");
    CHECK(bench.number("x.position") == 50);
}

TEST_CASE("MC_Home finds its signal, or knows the position at once") {
    MotionBench bench(straight);
    bench.set("home.Position", 30.0);
    bench.set("home.Execute", true);
    run_until(bench, "home.Done");
    CHECK(bench.number("x.position") == 30);
    bench.set("home.Execute", false);
    bench.step(2);
    bench.set("home.HomingMode", std::int64_t{2});
    bench.set("home.Position", 0.0);
    bench.set("home.Execute", true);
    bench.step(500);
    CHECK(bench.number("x.velocity") == Approx(20));
    CHECK(bench.is("status.Homing"));
    bench.set("home.Signal", true);
    run_until(bench, "home.Done");
    CHECK(bench.number("x.velocity") == 0);
    CHECK(bench.number("x.position") > 0);
    CHECK(bench.number("x.position") < 1);
}

TEST_CASE("MC_SetPosition gives the place another name, and moves nothing") {
    MotionBench bench(straight);
    bench.set("move.Execute", true);
    bench.step(100);
    bench.set("position.Execute", true);
    run_until(bench, "position.Done");
    const double renamed = bench.number("x.position");
    CHECK(std::abs(renamed - 7) < 0.2);
    run_until(bench, "move.Done");
    const double end = bench.axis("x").goal;
    CHECK(bench.number("x.position") == Approx(end));
}

namespace {

constexpr const char* queued = R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, default_velocity: 100 mm/s}
  one: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 50 mm}
  velocity: {type: MC_MoveVelocity, task: main, Axis: x, Velocity: 100 mm/s}
  position: {type: MC_SetPosition, task: main, Axis: x, Position: 7 mm, ExecutionMode: mcQueued}
  limit: {type: MC_WriteParameter, task: main, Axis: x, ParameterNumber: 9, Value: 20, ExecutionMode: mcQueued}
  switch: {type: MC_WriteBoolParameter, task: main, Axis: x, ParameterNumber: 4, Value: true, ExecutionMode: mcQueued}
  two: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 17 mm, BufferMode: mcBlendingHigh}
  home: {type: MC_Home, task: main, Axis: x, Position: -3 mm, BufferMode: mcBlendingNext}
  stop: {type: MC_Stop, task: main, Axis: x}
  added: {type: MC_MoveSuperimposed, task: main, Axis: x, Distance: 40 mm, VelocityDiff: 10 mm/s}
)";

}  // namespace

TEST_CASE("mcQueued: what sets something waits as a buffered command does") {
    MotionBench bench(queued);
    bench.set("one.Execute", true);
    bench.step(3);
    for (const char* next : {"position", "limit", "two"})
        bench.set(fmt::format("{}.Execute", next), true);
    bench.step(100);
    CHECK(bench.is("position.Busy"));
    CHECK_FALSE(bench.is("position.Active"));
    CHECK(bench.number("x.default_velocity") == 100);
    run_until(bench, "one.Done");
    CHECK(bench.is("position.Done"));
    CHECK(bench.is("limit.Done"));
    CHECK(bench.number("x.position") == Approx(7).margin(1e-9));
    CHECK(bench.number("x.velocity") == 0);
    CHECK(bench.number("x.default_velocity") == 20);
    bench.step(200);
    CHECK(bench.number("x.velocity") == Approx(20));
    run_until(bench, "two.Done");
    CHECK(bench.number("x.position") == 17);
}

TEST_CASE("mcQueued behind a velocity counts when that is reached, and ends nothing") {
    MotionBench bench(queued);
    bench.set("velocity.Execute", true);
    bench.step(20);
    bench.set("position.Execute", true);
    bench.set("limit.Execute", true);
    bench.step(10);
    CHECK(bench.is("position.Busy"));
    run_until(bench, "position.Done");
    CHECK(bench.is("velocity.InVelocity"));
    CHECK(bench.is("limit.Done"));
    const double at = bench.number("x.position");
    CHECK(std::abs(at - 7) < 0.1);
    bench.step(100);
    CHECK(bench.is("velocity.InVelocity"));
    CHECK(bench.number("x.position") == Approx(at + 10));
}

TEST_CASE("what is queued is aborted and fails as a buffered command, and counts at once at rest") {
    MotionBench bench(queued);
    bench.set("switch.Execute", true);
    bench.step(3);
    CHECK(bench.is("switch.Error"));
    CHECK(bench.text("switch.ErrorID") == "out_of_range");
    bench.set("one.Execute", true);
    bench.step(50);
    bench.set("position.Execute", true);
    bench.step(5);
    bench.set("stop.Execute", true);
    bench.step(3);
    CHECK(bench.is("position.CommandAborted"));
    bench.step(300);
    bench.set("position.Execute", false);
    bench.step(2);
    bench.set("position.Execute", true);
    bench.step(5);
    CHECK(bench.is("position.Busy"));
    bench.set("stop.Execute", false);
    run_until(bench, "position.Done");
    CHECK(bench.number("x.position") == 7);
}

TEST_CASE("MC_Home that is buffered begins where the axis stands, whatever was on top") {
    MotionBench bench(queued);
    bench.set("one.Execute", true);
    bench.step(100);
    bench.set("added.Execute", true);
    bench.set("home.Execute", true);
    bench.step(5);
    CHECK(bench.is("home.Busy"));
    CHECK_FALSE(bench.is("home.Active"));
    run_until(bench, "one.Done");
    CHECK(bench.is("added.CommandAborted"));
    run_until(bench, "home.Done");
    CHECK(bench.number("x.velocity") == 0);
    CHECK(bench.is("x.homed"));
    CHECK(bench.number("added.CoveredDistance") > 1);
    CHECK(std::abs(bench.number("x.position") + 3) < 0.2);
    bench.set("velocity.Execute", true);
    bench.step(50);
    bench.set("home.Execute", false);
    bench.step(2);
    bench.set("home.Execute", true);
    run_until(bench, "home.Error");
    CHECK(bench.text("home.ErrorID") == "wrong_state");
    CHECK_FALSE(bench.is("x.error"));
}

TEST_CASE("MC_WriteBoolParameter switches software limits, and takes no other number") {
    MotionBench bench(straight);
    bench.step(2);
    CHECK(bench.is("x.software_limits"));
    bench.set("switch.Execute", true);
    run_until(bench, "switch.Done");
    CHECK_FALSE(bench.is("x.software_limits"));
    bench.set("switch.Execute", false);
    bench.set("switch.ParameterNumber", std::int64_t{9});
    bench.step(2);
    bench.set("switch.Execute", true);
    run_until(bench, "switch.Error");
    CHECK(bench.text("switch.ErrorID") == "no_such_parameter");
    CHECK(bench.number("x.default_velocity") == 100);
}

TEST_CASE("a checkpoint in mid-command goes on to the same bytes") {
    const auto drive = [](MotionBench& bench, int ms) {
        if (ms == 5) bench.set("move.Execute", true);
        if (ms == 300) bench.set("velocity.Execute", true);
        bench.step();
    };
    for (int at = 1; at < 400; at += 37) {
        MotionBench whole(straight), resumed(straight);
        for (int ms = 0; ms < at; ++ms) drive(whole, ms);
        resumed.resume(whole.checkpoint(), whole.now() + 1);
        for (int ms = at; ms < 600; ++ms) {
            drive(whole, ms);
            drive(resumed, ms);
        }
        INFO("at " << at << " ms");
        CHECK(whole.checkpoint() == resumed.checkpoint());
    }
}

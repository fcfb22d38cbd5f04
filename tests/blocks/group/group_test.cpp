#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/group/axes_group.hpp"
#include "tests/blocks/motion/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// Three axes of a group, x before it in the file and the others behind it, and commands.
std::string table_with(const std::string& commands) {
    return R"(
tasks:
  servo: {every: 1 ms, priority: 20}
blocks:
  x: {type: axis, task: servo, software_limits: true, lowest_position: -50 mm, highest_position: 80 mm}
  group: {type: axes_group, task: servo, default_velocity: 50 mm/s, default_acceleration: 500 mm/s^2, default_jerk: 5000 mm/s^3}
  y: {type: axis, task: servo}
  turn: {type: axis, task: servo, unit: deg, modulo: true, period: 360 deg, start_position: 350 deg}
  add_x: {type: MC_AddAxisToGroup, task: servo, AxesGroup: group, Axis: x, IdentInGroup: 1, Execute: true}
  add_y: {type: MC_AddAxisToGroup, task: servo, AxesGroup: group, Axis: y, IdentInGroup: 2, Execute: add_x.Done}
  add_turn: {type: MC_AddAxisToGroup, task: servo, AxesGroup: group, Axis: turn, IdentInGroup: 4, Execute: add_y.Done}
  enable: {type: MC_GroupEnable, task: servo, AxesGroup: group, Execute: add_turn.Done}
)" + commands;
}

std::string state(const MotionBench& bench) {
    return std::string(
        group_state_names[static_cast<std::size_t>(bench.block<AxesGroup>("group").state)]);
}

/// Steps until the signal is true; so many milliseconds at most.
bool comes(MotionBench& bench, const char* signal, int most = 10'000) {
    for (int n = 0; n < most; ++n) {
        if (bench.is(signal)) return true;
        bench.step();
    }
    return false;
}

}  // namespace

TEST_CASE("group: a whole circle by its centre, and a rotary axis follows by time") {
    MotionBench bench(table_with(R"(
  circle: {type: MC_MoveCircularAbsolute, task: servo, AxesGroup: group, CircMode: mcCenter, AuxPoint1: 20 mm, PathChoice: mcCounterClockwise, EndPoint4: 310 deg}
)"));
    bench.step(20);
    bench.set("circle.Execute", true);
    double before = 350, lowest = 0;
    while (!bench.is("circle.Done")) {
        bench.step();
        const double x = bench.number("x.position"), y = bench.number("y.position");
        REQUIRE(std::hypot(x - 20, y) == Approx(20).epsilon(1e-13));
        const double way = bench.number("group.distance");
        const double turned = bench.number("turn.position");
        if (state(bench) == "moving")
            REQUIRE(turned == Approx(350 - 40 * way / (40 * std::numbers::pi)).epsilon(1e-12));
        REQUIRE(turned <= before);
        before = turned;
        lowest = std::min(lowest, y);
        REQUIRE(bench.now() < 10'000);
    }
    CHECK(lowest == Approx(-20).epsilon(1e-6));
    CHECK(bench.number("x.position") == 0);
    CHECK(bench.number("turn.position") == 310);
    CHECK(bench.number("group.distance") == Approx(40 * std::numbers::pi).epsilon(1e-12));
    bench.step(5);
    CHECK(bench.number("group.distance") == Approx(40 * std::numbers::pi).epsilon(1e-12));
    bench.set("circle.Execute", false);
    bench.step(2);
    bench.set("circle.Execute", true);
    bench.step(4);
    CHECK(bench.number("group.distance") < 1);
}

TEST_CASE("group: arcs by a border, and by a radius, relative and clockwise") {
    MotionBench bench(table_with(R"(
  border: {type: MC_MoveCircularRelative, task: servo, AxesGroup: group, CircMode: mcBorder, AuxPoint1: 10 mm, AuxPoint2: 10 mm, EndPoint1: 20 mm}
  radius: {type: MC_MoveCircularRelative, task: servo, AxesGroup: group, CircMode: mcRadius, AuxPoint3: 10 mm, EndPoint1: 10 mm, EndPoint2: 10 mm, BufferMode: mcBuffered}
)"));
    bench.step(20);
    bench.set("border.Execute", true);
    bench.set("radius.Execute", true);
    double highest = 0;
    while (!bench.is("border.Done")) {
        bench.step();
        highest = std::max(highest, bench.number("y.position"));
    }
    CHECK(highest == Approx(10).epsilon(1e-4));
    CHECK(bench.number("x.position") == Approx(20).margin(0.01));
    while (!bench.is("radius.Done")) {
        bench.step();
        // From (20, 0) clockwise to (30, 10) about (30, 0).
        REQUIRE(std::hypot(bench.number("x.position") - 30, bench.number("y.position")) ==
                Approx(10).epsilon(1e-6));
    }
    CHECK(bench.number("x.position") == 30);
    CHECK(bench.number("y.position") == 10);
}

TEST_CASE("group: corners are passed in motion within their deviation, or are a stop") {
    for (const bool rounds : {false, true}) {
        MotionBench bench(table_with(fmt::format(R"(
  first: {{type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 40 mm, Position4: 350 deg}}
  second: {{type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 40 mm, Position2: 40 mm, Position4: 350 deg, BufferMode: {}, TransitionMode: mcTMMaxCornerDeviation, TransitionParameter: 0.5 mm}}
)",
                                                 rounds ? "mcBlendingLow" : "mcBuffered")));
        bench.step(20);
        bench.set("first.Execute", true);
        bench.set("second.Execute", true);
        double nearest = 1e9, slowest = 1e9;
        while (!bench.is("second.Done")) {
            bench.step();
            const double x = bench.number("x.position"), y = bench.number("y.position");
            nearest = std::min(nearest, std::hypot(x - 40, y));
            if (x + y > 30 && x + y < 50)
                slowest = std::min(slowest, bench.number("group.velocity"));
        }
        // It is seen in whole milliseconds only, so not exactly where it is nearest.
        CHECK(nearest <= (rounds ? 0.502 : 1e-3));
        CHECK(nearest >= (rounds ? 0.5 : 0));
        CHECK((slowest > 5) == rounds);
        CHECK(bench.number("y.position") == 40);
    }
}

TEST_CASE("group: a target, or an arc, outside of software limits is refused before it moves") {
    MotionBench bench(table_with(R"(
  far: {type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 81 mm}
  wide: {type: MC_MoveCircularAbsolute, task: servo, AxesGroup: group, AuxPoint1: 90 mm, AuxPoint2: 45 mm, EndPoint2: 90 mm}
)"));
    bench.step(20);
    for (const std::string name : {"far", "wide"}) {
        bench.set(name + ".Execute", true);
        bench.step(5);
        CHECK(bench.is(name + ".Error"));
        CHECK(std::get<std::int64_t>(bench.get(name + ".ErrorID")) ==
              static_cast<std::int64_t>(MotionError::software_limit));
        CHECK(bench.number("x.position") == 0);
        CHECK(state(bench) == "standby");
    }
}

TEST_CASE("group: interrupt keeps the path and its command, halt and stop give it up") {
    MotionBench bench(table_with(R"(
  line: {type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 60 mm, Position2: 30 mm, Position4: 350 deg}
  interrupt: {type: MC_GroupInterrupt, task: servo, AxesGroup: group}
  resume: {type: MC_GroupContinue, task: servo, AxesGroup: group}
  halt: {type: MC_GroupHalt, task: servo, AxesGroup: group}
  stop: {type: MC_GroupStop, task: servo, AxesGroup: group}
  override: {type: MC_GroupSetOverride, task: servo, AxesGroup: group}
)"));
    bench.step(20);
    bench.set("line.Execute", true);
    bench.step(500);
    bench.set("interrupt.Execute", true);
    REQUIRE(comes(bench, "interrupt.Done", 400));
    CHECK(state(bench) == "moving");
    CHECK(bench.is("line.Busy"));
    CHECK_FALSE(bench.is("line.Active"));
    const double x = bench.number("x.position");
    bench.step(100);
    CHECK(bench.number("x.position") == x);
    CHECK(bench.number("y.position") == Approx(x / 2).epsilon(1e-14));
    bench.set("resume.Execute", true);
    bench.step(200);
    CHECK(bench.is("line.Active"));
    bench.set("override.VelFactor", 0.2);
    bench.set("override.Enable", true);
    bench.step(300);
    CHECK(bench.number("group.velocity") == Approx(10).epsilon(1e-9));
    bench.set("halt.Execute", true);
    REQUIRE(comes(bench, "halt.Done", 400));
    CHECK(bench.is("line.CommandAborted"));
    CHECK(state(bench) == "standby");
    CHECK(bench.number("y.position") == Approx(bench.number("x.position") / 2).epsilon(1e-14));
    bench.set("override.VelFactor", 1.0);
    bench.set("line.Execute", false);
    bench.step(2);
    bench.set("line.Execute", true);
    bench.step(150);
    bench.set("stop.Execute", true);
    REQUIRE(comes(bench, "stop.Done", 400));
    CHECK(state(bench) == "stopping");
    bench.set("line.Execute", false);
    bench.step(2);
    bench.set("line.Execute", true);
    bench.step(3);
    CHECK(std::get<std::int64_t>(bench.get("line.ErrorID")) ==
          static_cast<std::int64_t>(MotionError::group_stopping));
    bench.set("stop.Execute", false);
    bench.step(3);
    CHECK(state(bench) == "standby");
}

TEST_CASE("group: power is that of all axes, and without it the path is left") {
    MotionBench bench(table_with(R"(
  power: {type: MC_GroupPower, task: servo, AxesGroup: group, Enable: true}
  line: {type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 60 mm, Position2: 30 mm, Position4: 350 deg}
  reset: {type: MC_GroupReset, task: servo, AxesGroup: group}
)"));
    bench.step(20);
    CHECK(bench.is("power.Status"));
    CHECK(bench.is("power.Valid"));
    bench.set("line.Execute", true);
    bench.step(500);
    bench.set("power.Enable", false);
    bench.step(3);
    CHECK_FALSE(bench.is("power.Status"));
    CHECK(bench.is("line.Error"));
    CHECK(state(bench) == "error_stop");
    bench.step(2000);
    CHECK(bench.number("x.velocity") == 0);
    bench.set("line.Execute", false);
    bench.set("power.Enable", true);
    bench.set("reset.Execute", true);
    REQUIRE(comes(bench, "reset.Done", 400));
    CHECK(bench.is("power.Status"));
    bench.set("line.Execute", true);
    REQUIRE(comes(bench, "line.Done"));
    CHECK(bench.number("y.position") == 30);
}

TEST_CASE("group: a move that aborts begins where the group has stopped on its path") {
    MotionBench bench(table_with(R"(
  first: {type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 60 mm, Position4: 350 deg}
  second: {type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position2: 20 mm, Position4: 350 deg}
)"));
    bench.step(20);
    bench.set("first.Execute", true);
    bench.step(500);
    bench.set("second.Execute", true);
    bench.step(3);
    CHECK(bench.is("first.CommandAborted"));
    CHECK(bench.is("second.Busy"));
    double greatest = 0;
    while (bench.number("y.position") == 0) {
        bench.step();
        greatest = std::max(greatest, bench.number("x.position"));
    }
    REQUIRE(comes(bench, "second.Done"));
    CHECK(greatest < 60);
    CHECK(bench.number("x.position") == 0);
    CHECK(bench.number("y.position") == 20);
}

TEST_CASE("group: an axis that fails stops the others on the path, until all are reset") {
    MotionBench bench(table_with(R"(
  line: {type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 60 mm, Position2: 30 mm, Position4: 350 deg}
  power: {type: MC_Power, task: servo, Axis: y, Enable: true}
  reset: {type: MC_GroupReset, task: servo, AxesGroup: group}
)"));
    bench.step(20);
    bench.set("line.Execute", true);
    bench.step(500);
    bench.set("power.Enable", false);
    bench.step(5);
    CHECK(state(bench) == "error_stop");
    CHECK(std::get<std::int64_t>(bench.get("line.ErrorID")) ==
          static_cast<std::int64_t>(MotionError::axis_left_path));
    bench.step(500);
    CHECK(bench.number("x.velocity") == 0);
    CHECK(bench.axis("x").state == AxisState::standstill);
    bench.set("reset.Execute", true);
    bench.set("power.Enable", true);
    REQUIRE(comes(bench, "reset.Done", 20));
    CHECK(state(bench) == "standby");
    bench.set("line.Execute", false);
    bench.step(2);
    bench.set("line.Execute", true);
    REQUIRE(comes(bench, "line.Done"));
    CHECK(bench.number("x.position") == 60);
    CHECK(bench.number("y.position") == 30);
}

TEST_CASE("group: a table is run along, longer than the path looks ahead") {
    std::string points;
    for (int i = 1; i <= 200; ++i)
        points +=
            fmt::format("{}[{} mm, {} mm, 0 mm, line, 0 mm, 0 mm, 0 mm, 350 deg, 0 deg, 0 deg]",
                        i > 1 ? ", " : "", 0.3 * i, i % 2);
    MotionBench bench(table_with(fmt::format(R"(
  zigzag: {{type: path_table, task: servo, points: [{}]}}
  path: {{type: MC_MovePath, task: servo, AxesGroup: group, PathData: zigzag, TransitionMode: mcTMMaxCornerDeviation, TransitionParameter: 0.05 mm}}
  after: {{type: MC_MoveLinearRelative, task: servo, AxesGroup: group, Distance2: 5 mm, BufferMode: mcBuffered}}
)",
                                             points)));
    bench.step(20);
    bench.set("path.Execute", true);
    bench.step();
    bench.set("after.Execute", true);
    REQUIRE(comes(bench, "path.Done", 60'000));
    CHECK(bench.is("after.Busy"));
    REQUIRE(comes(bench, "after.Done"));
    CHECK(bench.number("x.position") == Approx(60).epsilon(1e-15));
    CHECK(bench.number("y.position") == 5);
}

TEST_CASE("group: a corner is passed with the limits of the move that its mode of blending names") {
    struct Case {
        const char* mode;
        double first, second, most;
    };
    for (const Case& c : {Case{"mcBlendingLow", 20, 45, 20},
                          {"mcBlendingLow", 45, 20, 20},
                          {"mcBlendingPrevious", 20, 45, 20},
                          {"mcBlendingPrevious", 45, 20, 45},
                          {"mcBlendingNext", 20, 45, 45},
                          {"mcBlendingNext", 45, 20, 20},
                          {"mcBlendingHigh", 20, 45, 45},
                          {"mcBlendingHigh", 45, 20, 45}}) {
        CAPTURE(c.mode, c.first, c.second);
        MotionBench bench(table_with(fmt::format(R"(
  first: {{type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 40 mm, Position4: 350 deg, Velocity: {} mm/s}}
  second: {{type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 80 mm, Position2: 5 mm, Position4: 350 deg, Velocity: {} mm/s, BufferMode: {}, TransitionMode: mcTMCornerDistance, TransitionParameter: 10 mm}}
)",
                                                 c.first, c.second, c.mode)));
        bench.step(20);
        bench.set("first.Execute", true);
        bench.set("second.Execute", true);
        double before = 0, within = 0, behind = 0;
        while (!bench.is("second.Done")) {
            bench.step();
            const double x = bench.number("x.position"), v = bench.number("group.velocity");
            double& most = x <= 30                                ? before
                           : x < 40 + 10 * 40 / std::hypot(40, 5) ? within
                                                                  : behind;
            most = std::max(most, v);
            REQUIRE(bench.now() < 20'000);
        }
        CHECK(before == Approx(c.first).epsilon(1e-9));
        CHECK(within == Approx(c.most).epsilon(0.02));
        CHECK(within <= c.most * (1 + 1e-9));
        CHECK(behind == Approx(c.second).epsilon(1e-9));
    }
}

TEST_CASE("group: a table of splines is passed without a stop, from a line into an arc") {
    MotionBench bench(table_with(R"(
  way: {type: path_table, task: servo, points: [[10 mm, 0 mm, 0 mm, line, 0 mm, 0 mm, 0 mm, 350 deg, 0 deg, 0 deg], [25 mm, 8 mm, 0 mm, spline, 0 mm, 0 mm, 0 mm, 340 deg, 0 deg, 0 deg], [40 mm, -6 mm, 0 mm, spline, 0 mm, 0 mm, 0 mm, 345 deg, 0 deg, 0 deg], [60 mm, 0 mm, 0 mm, spline, 0 mm, 0 mm, 0 mm, 350 deg, 0 deg, 0 deg], [65 mm, 5 mm, 0 mm, arc, 62 mm, 1 mm, 0 mm, 350 deg, 0 deg, 0 deg]]}
  path: {type: MC_MovePath, task: servo, AxesGroup: group, PathData: way}
)"));
    bench.step(20);
    bench.set("path.Execute", true);
    bool past = false;
    double slowest = 50, highest = 0;
    while (!bench.is("path.Done")) {
        bench.step();
        REQUIRE_FALSE(bench.is("path.Error"));
        const double x = bench.number("x.position"), y = bench.number("y.position");
        if (x > 5 && x < 55) slowest = std::min(slowest, bench.number("group.velocity"));
        if (x < 10) REQUIRE(std::abs(y) <= 1e-12);
        if (!past && x >= 25) CHECK(y == Approx(8).margin(0.05));
        past = past || x >= 25;
        highest = std::max(highest, y);
        REQUIRE(bench.now() < 20'000);
    }
    CHECK(slowest > 10);
    CHECK(highest < 10);
    CHECK(bench.number("x.position") == 65);
    CHECK(bench.number("y.position") == 5);
    CHECK(bench.number("turn.position") == 350);
}

TEST_CASE("group: a table of a cubic spline is passed without a stop") {
    MotionBench bench(table_with(R"(
  way: {type: path_table, task: servo, points: [[10 mm, 5 mm, 0 mm, cubic, 0 mm, 0 mm, 0 mm, 350 deg, 0 deg, 0 deg], [20 mm, -3 mm, 0 mm, cubic, 0 mm, 0 mm, 0 mm, 350 deg, 0 deg, 0 deg], [30 mm, 4 mm, 0 mm, cubic, 0 mm, 0 mm, 0 mm, 350 deg, 0 deg, 0 deg]]}
  path: {type: MC_MovePath, task: servo, AxesGroup: group, PathData: way}
)"));
    bench.step(20);
    bench.set("path.Execute", true);
    double slowest = 50, nearest = 50;
    while (!bench.is("path.Done")) {
        bench.step();
        REQUIRE_FALSE(bench.is("path.Error"));
        const double x = bench.number("x.position"), y = bench.number("y.position");
        if (x > 5 && x < 25) slowest = std::min(slowest, bench.number("group.velocity"));
        nearest = std::min(nearest, std::hypot(x - 20, y + 3));
        REQUIRE(bench.now() < 20'000);
    }
    CHECK(slowest > 5);
    CHECK(nearest < 0.05);
    CHECK(bench.number("x.position") == 30);
    CHECK(bench.number("y.position") == 4);
}

TEST_CASE("group: a line runs into an arc within the deviation asked for, without a stop") {
    MotionBench bench(table_with(R"(
  line: {type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 20 mm, Position4: 350 deg}
  arc: {type: MC_MoveCircularAbsolute, task: servo, AxesGroup: group, AuxPoint1: 40 mm, AuxPoint2: 20 mm, EndPoint1: 20 mm, EndPoint2: 40 mm, EndPoint4: 350 deg, BufferMode: mcBlendingLow, TransitionMode: mcTMMaxCornerDeviation, TransitionParameter: 0.02 mm}
)"));
    bench.step(20);
    bench.set("line.Execute", true);
    bench.set("arc.Execute", true);
    double slowest = 50, most = 0;
    while (!bench.is("arc.Done")) {
        bench.step();
        const double x = bench.number("x.position"), y = bench.number("y.position");
        const double way = bench.number("group.distance");
        if (way > 10 && way < 60) slowest = std::min(slowest, bench.number("group.velocity"));
        most = std::max(most, x < 20 && y < 20 ? y : std::abs(std::hypot(x - 20, y - 20) - 20));
        REQUIRE(bench.now() < 20'000);
    }
    CHECK(slowest > 10);
    CHECK(most <= 0.02);
    CHECK(bench.number("y.position") == 40);
}

TEST_CASE(
    "group: a halt brakes as its pins say, gentler or harder than the moves, a stop as these "
    "allow") {
    for (const std::string command : {"halt", "stop", "emergency"}) {
        MotionBench bench(table_with(R"(
  line: {type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 70 mm, Position4: 350 deg}
  halt: {type: MC_GroupHalt, task: servo, AxesGroup: group, Deceleration: 100 mm/s^2, Jerk: 1000 mm/s^3}
  stop: {type: MC_GroupStop, task: servo, AxesGroup: group}
  emergency: {type: MC_GroupStop, task: servo, AxesGroup: group, Deceleration: 800 mm/s^2, Jerk: 9000 mm/s^3}
)"));
        bench.step(20);
        bench.set("line.Execute", true);
        bench.step(500);
        const double deceleration = command == "halt" ? 100 : command == "stop" ? 500 : 800;
        bench.set(command + ".Execute", true);
        double hardest = 0, most = 0;
        while (!bench.is(command + ".Done")) {
            bench.step();
            hardest = std::max(hardest, -bench.number("group.acceleration"));
            most = std::max(most, std::abs(bench.number("group.jerk")));
            REQUIRE(bench.now() < 5'000);
        }
        CHECK(hardest <= deceleration * (1 + 1e-9));
        CHECK(hardest >= 0.8 * deceleration);
        CHECK(most == Approx(command == "halt" ? 1000 : command == "stop" ? 5000 : 9000));
    }
}

TEST_CASE("group: all axes leave it as soon as they stand, and can join another one") {
    MotionBench bench(table_with(R"(
  other: {type: axes_group, task: servo}
  again: {type: MC_AddAxisToGroup, task: servo, AxesGroup: other, Axis: y}
  line: {type: MC_MoveLinearAbsolute, task: servo, AxesGroup: group, Position1: 10 mm, Position4: 350 deg}
  ungroup: {type: MC_UngroupAllAxes, task: servo, AxesGroup: group}
  back: {type: MC_GroupEnable, task: servo, AxesGroup: group, Execute: line.CommandAborted}
)"));
    bench.step(20);
    bench.set("line.Execute", true);
    bench.step(50);
    bench.set("ungroup.Execute", true);
    bench.step(2);
    CHECK((bench.is("line.CommandAborted") && bench.is("ungroup.Busy")));
    CHECK(state(bench) == "disabled");
    CHECK(bench.number("group.velocity") > 0);
    bench.set("again.Execute", true);
    bench.step(2);
    CHECK((bench.is("again.Error") && bench.is("back.Error")));
    bench.set("again.Execute", false);
    REQUIRE(comes(bench, "ungroup.Done"));
    CHECK(bench.number("x.velocity") == 0);
    bench.set("again.Execute", true);
    CHECK(comes(bench, "again.Done", 3));
}

TEST_CASE("group: what cannot be a member is refused") {
    MotionBench bench(R"(
tasks:
  servo: {every: 1 ms, priority: 20}
  main: {every: 2 ms, priority: 1}
blocks:
  group: {type: axes_group, task: servo}
  other: {type: axes_group, task: servo}
  x: {type: axis, task: servo}
  turn: {type: axis, task: servo, unit: deg}
  slow: {type: axis, task: main}
  add: {type: MC_AddAxisToGroup, task: servo, AxesGroup: group, Axis: x}
  again: {type: MC_AddAxisToGroup, task: servo, AxesGroup: other, Axis: x}
  wrong: {type: MC_AddAxisToGroup, task: servo, AxesGroup: group, Axis: turn, IdentInGroup: 2}
  late: {type: MC_AddAxisToGroup, task: servo, AxesGroup: group, Axis: slow, IdentInGroup: 2}
  enable: {type: MC_GroupEnable, task: servo, AxesGroup: group}
  remove: {type: MC_RemoveAxisFromGroup, task: servo, AxesGroup: group}
)");
    bench.step(10);
    const auto error = [&](const std::string& name) {
        bench.set(name + ".Execute", true);
        bench.step(3);
        bench.set(name + ".Execute", false);
        return static_cast<MotionError>(std::get<std::int64_t>(bench.get(name + ".ErrorID")));
    };
    CHECK(error("add") == MotionError::none);
    CHECK(error("again") == MotionError::already_in_group);
    CHECK(error("wrong") == MotionError::unit_of_group);
    CHECK(error("late") == MotionError::task_of_group);
    CHECK(error("enable") == MotionError::too_few_axes);
    CHECK(error("remove") == MotionError::none);
    CHECK(error("again") == MotionError::none);
}

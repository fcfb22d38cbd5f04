#include "blocks/motion/reads.hpp"

#include <catch2/catch.hpp>

#include "tests/blocks/motion/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// An axis whose drive follows 10 ms later, as a delay; and one without.
constexpr const char* driven = R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, has_drive: true, software_limits: true, lowest_position: -100 mm, highest_position: 50 mm}
  z: {type: axis, task: main}
  move: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 50 mm}
  set: {type: MC_SetPosition, task: main, Axis: x, Position: 60 mm}
  home: {type: MC_Home, task: main, Axis: z}
  power: {type: MC_Power, task: main, Axis: x, Enable: true}
  commanded: {type: MC_ReadMotionState, task: main, Axis: x, Enable: true}
  measured: {type: MC_ReadMotionState, task: main, Axis: x, Enable: true, Source: mcActualValue}
  info: {type: MC_ReadAxisInfo, task: main, Axis: x, Enable: true}
  other: {type: MC_ReadAxisInfo, task: main, Axis: z, Enable: true}
  wanted: {type: MC_ReadSetPosition, task: main, Axis: x, Enable: true}
  actual: {type: MC_ReadActualPosition, task: main, Axis: x, Enable: true}
  switched: {type: MC_ReadBoolParameter, task: main, Axis: x, Enable: true}
)";

}  // namespace

TEST_CASE("MC_ReadMotionState tells of the set-point, or of what the drive measures") {
    MotionBench bench(driven);
    bench.set("move.Execute", true);
    std::vector<double> way;
    const auto step = [&] {
        const auto delay = way.size() > 10 ? way.size() - 11 : 0;
        bench.set("x.actual_position", way.empty() ? 0.0 : way[delay]);
        bench.step();
        way.push_back(bench.number("x.position"));
    };
    bool was_behind = false;
    for (int ms = 0; ms < 3000 && !(bench.is("move.Done") && way.size() > 700); ++ms) {
        step();
        was_behind |= bench.is("commanded.Decelerating") && !bench.is("measured.Decelerating") &&
                      bench.is("measured.DirectionPositive");
        if (bench.number("x.velocity") == 100 && way.size() > 200 && way.size() < 400)
            CHECK(bench.is("commanded.ConstantVelocity"));
    }
    CHECK(was_behind);
    for (int ms = 0; ms < 20; ++ms) step();
    CHECK(bench.is("measured.ConstantVelocity"));
    CHECK_FALSE(bench.is("measured.DirectionPositive"));
}

TEST_CASE("a drive that speeds up and slows down is told from its measured speed") {
    MotionBench bench(driven);
    double position = 0;
    const auto move = [&](double by) {
        position += by;
        bench.set("x.actual_position", position);
        bench.step();
    };
    move(0);
    move(0);
    move(-0.5);
    CHECK(bench.is("measured.Accelerating"));
    CHECK(bench.is("measured.DirectionNegative"));
    move(-0.25);
    CHECK(bench.is("measured.Decelerating"));
    move(-0.25);
    CHECK(bench.is("measured.ConstantVelocity"));
    CHECK_FALSE(bench.is("commanded.DirectionNegative"));
}

TEST_CASE("MC_ReadAxisInfo tells of drive, power, homing and limits") {
    MotionBench bench(driven);
    bench.step(3);
    for (const char* fine : {"info.CommunicationReady", "info.ReadyForPowerOn", "info.PowerOn"})
        CHECK(bench.is(fine));
    CHECK_FALSE(bench.is("info.Simulation"));
    CHECK(bench.is("other.Simulation"));
    CHECK_FALSE(bench.is("other.IsHomed"));
    bench.set("home.Execute", true);
    bench.set("x.actual_position", 50.0);
    bench.set("power.Enable", false);
    bench.step(5);
    CHECK(bench.is("other.IsHomed"));
    CHECK(bench.is("info.LimitSwitchPos"));
    CHECK_FALSE(bench.is("info.LimitSwitchNeg"));
    CHECK_FALSE(bench.is("info.AxisWarning"));
    CHECK_FALSE(bench.is("info.PowerOn"));
    bench.set("x.actual_position", -100.5);
    bench.step(2);
    CHECK(bench.is("info.LimitSwitchNeg"));
    CHECK(bench.is("info.AxisWarning"));
}

TEST_CASE("MC_ReadSetPosition tells where an axis is to be, whatever its drive measures") {
    MotionBench bench(driven);
    bench.set("move.Execute", true);
    bench.step(200);
    const double before = bench.number("x.position");
    bench.step();
    CHECK(before > 0);
    CHECK(bench.is("wanted.Valid"));
    CHECK(bench.number("wanted.Position") >= before);
    CHECK(bench.number("actual.Position") == 0);
}

TEST_CASE("MC_ReadBoolParameter knows software limits, and no number that is not a BOOL") {
    MotionBench bench(driven);
    bench.step(2);
    CHECK(bench.is("switched.Value"));
    CHECK(bench.is("switched.Valid"));
    bench.set("switched.ParameterNumber", std::int64_t{9});
    bench.step();
    CHECK(bench.is("switched.Error"));
    CHECK_FALSE(bench.is("switched.Valid"));
}

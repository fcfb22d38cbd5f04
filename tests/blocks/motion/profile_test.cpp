#include <cmath>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/axis/cam_table.hpp"
#include "blocks/motion/synchronous.hpp"
#include "tests/blocks/motion/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// An axis at 10 mm, a profile of positions that begins there, and one of velocities.
std::string program(const std::string& position = ", Offset: 10 mm",
                    const std::string& velocity = {}, const std::string& acceleration = {}) {
    return fmt::format(R"(
tasks: {{main: {{every: 1 ms}}}}
blocks:
  x: {{type: axis, task: main, start_position: 10 mm, default_velocity: 200 mm/s}}
  way: {{type: cam_table, task: main, master_unit: s, points: [[0 s, 0 mm, 0 mm/s, 0 mm/s^2], [0.5 s, 25 mm], [0.8 s, 30 mm], [1.2 s, 12 mm, 0 mm/s, 0 mm/s^2]]}}
  speed: {{type: cam_table, task: main, unit: mm/s, master_unit: s, points: [[0 s, 0 mm/s, 0 mm/s^2], [0.4 s, 40 mm/s], [1 s, 20 mm/s, 0 mm/s^2]]}}
  position: {{type: MC_PositionProfile, task: main, Axis: x, TimePosition: way{}}}
  velocity: {{type: MC_VelocityProfile, task: main, Axis: x, TimeVelocity: speed{}}}
  push: {{type: cam_table, task: main, unit: mm/s^2, master_unit: s, points: [[0 s, 0 mm/s^2], [0.2 s, 300 mm/s^2], [0.5 s, -100 mm/s^2], [0.6 s, 0 mm/s^2]]}}
  acceleration: {{type: MC_AccelerationProfile, task: main, Axis: x, TimeAcceleration: push{}}}
  halt: {{type: MC_Halt, task: main, Axis: x}}
)",
                       position, velocity, acceleration);
}

MotionError answer(const std::string& text, const char* block) {
    MotionBench bench(text);
    bench.set(fmt::format("{}.Execute", block), true);
    bench.step(5);
    const CommandBlock& command = bench.block<PositionProfile>(block);
    CHECK(command.error != command.busy);
    if (command.error) CHECK(bench.number("x.position") == 10);
    return command.error_id;
}

}  // namespace

TEST_CASE("MC_PositionProfile follows the table, scaled, and ends in rest at its last point") {
    MotionBench bench(program(", Offset: 10 mm, TimeScale: 2, PositionScale: -0.5"));
    const Cam cam = bench.block<CamTable>("way").cam(false);
    bench.set("position.Execute", true);
    bench.step(2);  // the axis takes the command up in its second scan
    double v = 0, a = 0;
    for (int ms = 1; ms < 2400; ++ms) {
        bench.step();
        const CurvePoint p = cam.at(ms / 2000.0);
        REQUIRE(bench.number("x.position") == Approx(10 - 0.5 * p.y).margin(1e-12));
        REQUIRE(bench.number("x.velocity") == Approx(-0.25 * p.slope).margin(1e-9));
        REQUIRE(std::abs(bench.number("x.velocity") - v) <= 1000 * 1e-3);
        REQUIRE(std::abs(bench.number("x.acceleration") - a) <= 5e4 * 1e-3);
        v = bench.number("x.velocity");
        a = bench.number("x.acceleration");
        REQUIRE(bench.axis("x").state == AxisState::discrete_motion);
        REQUIRE(bench.is("position.Busy"));
    }
    bench.step(2);
    CHECK(bench.number("x.position") == 4);
    CHECK(bench.number("x.velocity") == 0);
    CHECK(bench.is("position.Done"));
    CHECK(bench.axis("x").state == AxisState::standstill);
}

TEST_CASE("MC_VelocityProfile moves by the integral of the table, and on with its last velocity") {
    MotionBench bench(program(", Offset: 10 mm", ", VelocityScale: 2, TimeScale: 0.5"));
    const Cam cam = bench.block<CamTable>("speed").cam(false);
    bench.set("velocity.Execute", true);
    bench.step(2);
    constexpr int parts = 100;  // of a millisecond, for Simpson's rule
    double position = 10;
    for (int ms = 1; ms < 500; ++ms) {
        bench.step();
        for (int i = 0; i < parts; ++i) {
            const double h = 2e-3 / parts, x = (ms - 1) * 2e-3 + i * h;
            const double mean = (cam.at(x).y + 4 * cam.at(x + h / 2).y + cam.at(x + h).y) / 6;
            position += 2 * mean * h * 0.5;
        }
        REQUIRE(bench.number("x.velocity") == Approx(2 * cam.at(ms * 2e-3).y).margin(1e-9));
        REQUIRE(bench.number("x.position") == Approx(position).epsilon(1e-10));
        REQUIRE_FALSE(bench.is("velocity.ProfileCompleted"));
    }
    bench.step(3);
    CHECK(bench.is("velocity.ProfileCompleted"));
    CHECK(bench.is("velocity.Busy"));
    CHECK(bench.axis("x").state == AxisState::continuous_motion);
    const double at = bench.number("x.position");
    bench.step(100);
    CHECK(bench.number("x.velocity") == Approx(40));
    CHECK(bench.number("x.position") - at == Approx(4));
    bench.set("halt.Execute", true);
    bench.step(300);
    CHECK(bench.is("velocity.CommandAborted"));
    CHECK(bench.is("halt.Done"));
}

TEST_CASE("MC_AccelerationProfile moves by the integrals of the table, and on with its velocity") {
    MotionBench bench(program(", Offset: 10 mm", "", ", AccelerationScale: 0.5, TimeScale: 2"));
    const Cam cam = bench.block<CamTable>("push").cam(false);
    bench.set("acceleration.Execute", true);
    bench.step(2);
    constexpr int parts = 100;  // of a millisecond, for Simpson's rule
    double position = 10, v = 0;
    for (int ms = 1; ms < 1200; ++ms) {
        bench.step();
        for (int i = 0; i < parts; ++i) {
            const double h = 1e-3 / parts, t = (ms - 1) * 1e-3 + i * h;
            const auto a = [&](double at) { return 0.5 * cam.at(0.5 * at).y; };
            const double half = v + 0.5 * h * (a(t) + 4 * a(t + h / 4) + a(t + h / 2)) / 6;
            const double next = v + h * (a(t) + 4 * a(t + h / 2) + a(t + h)) / 6;
            position += h * (v + 4 * half + next) / 6;
            v = next;
        }
        REQUIRE(bench.number("x.acceleration") == Approx(0.5 * cam.at(ms * 5e-4).y).margin(1e-9));
        REQUIRE(bench.number("x.velocity") == Approx(v).margin(1e-9));
        REQUIRE(bench.number("x.position") == Approx(position).epsilon(1e-10));
        REQUIRE_FALSE(bench.is("acceleration.ProfileCompleted"));
    }
    bench.step(3);
    CHECK(bench.is("acceleration.ProfileCompleted"));
    CHECK(bench.axis("x").state == AxisState::continuous_motion);
    CHECK(bench.number("x.velocity") == Approx(v));
    CHECK(bench.number("x.acceleration") == 0);
    const double at = bench.number("x.position");
    bench.step(100);
    CHECK(bench.number("x.position") - at == Approx(0.1 * v));
}

TEST_CASE(
    "a profile of accelerations that leads beyond a limit or does not end with 0 is refused") {
    CHECK(answer(program(), "acceleration") == MotionError::none);
    CHECK(answer(program("", "", ", Offset: 10 mm/s^2"), "acceleration") ==
          MotionError::out_of_range);
    CHECK(answer(program("", "", ", AccelerationScale: 5"), "acceleration") ==
          MotionError::sync_limits);
    CHECK(answer(program("", "", ", TimeScale: 20"), "acceleration") == MotionError::sync_limits);
    std::string limited = program();
    limited.insert(limited.find("start_position"),
                   "software_limits: true, lowest_position: 0 mm, highest_position: 30 mm, ");
    CHECK(answer(limited, "acceleration") == MotionError::software_limit);
    std::string other = program();
    other.replace(other.find("TimeAcceleration: push"), 22, "TimeAcceleration: speed");
    CHECK(answer(other, "acceleration") == MotionError::no_cam);
    MotionBench backwards(program("", "", ", AccelerationScale: -0.2"));
    backwards.set("acceleration.Execute", true);
    backwards.step(500);
    CHECK(backwards.number("x.position") < 10);
}

TEST_CASE("a profile that the axis cannot follow is refused, and nothing moves") {
    CHECK(answer(program(), "position") == MotionError::none);
    CHECK(answer(program(", Offset: 11 mm"), "position") == MotionError::out_of_range);
    CHECK(answer(program(", Offset: 10 mm, TimeScale: 0"), "position") ==
          MotionError::out_of_range);
    CHECK(answer(program(", Offset: 10 mm, TimeScale: 0.05"), "position") ==
          MotionError::sync_limits);
    CHECK(answer(program(", Offset: 10 mm", ", Offset: 1 mm/s"), "velocity") ==
          MotionError::out_of_range);
    CHECK(answer(program(", Offset: 10 mm", ", VelocityScale: 100"), "velocity") ==
          MotionError::sync_limits);
    std::string other = program();
    other.replace(other.find("TimePosition: way"), 17, "TimePosition: speed");
    CHECK(answer(other, "position") == MotionError::no_cam);
}

TEST_CASE("a buffered profile begins at the end of the move before, to the nanosecond") {
    std::string text = program(", Offset: 10 mm, BufferMode: mcBuffered");
    text.replace(text.find("start_position: 10 mm"), 21, "start_position: 0 mm");
    text.insert(text.find("  position:"),
                "  there: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 10 mm, "
                "Velocity: 77 mm/s}\n");
    MotionBench bench(text);
    bench.set("there.Execute", true);
    bench.set("position.Execute", true);
    double v = 0;
    for (int ms = 0; ms < 2500 && !bench.is("position.Done"); ++ms) {
        bench.step();
        REQUIRE(std::abs(bench.number("x.velocity") - v) <= 1000 * 1e-3 * (1 + 1e-9));
        v = bench.number("x.velocity");
    }
    CHECK(bench.is("position.Done"));
    CHECK(bench.number("x.position") == 22);
}

TEST_CASE("a checkpoint in mid-profile goes on to the same bytes") {
    for (const char* name : {"position.Execute", "velocity.Execute", "acceleration.Execute"}) {
        MotionBench whole(program()), resumed(program());
        whole.set(name, true);
        whole.step(333);
        resumed.resume(whole.checkpoint(), whole.now() + 1);
        whole.step(1500);
        resumed.step(1500);
        CHECK(whole.checkpoint() == resumed.checkpoint());
    }
}

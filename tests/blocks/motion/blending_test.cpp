#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "runtime/model/random.hpp"
#include "tests/blocks/motion/bench.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr std::int64_t modes = 6;

/// Two moves by 40 mm, the second of them buffered, with limits of jerk.
constexpr const char* two_moves = R"(
tasks: {main: {every: 1 ms}}
blocks:
  x: {type: axis, task: main, default_acceleration: 1000 mm/s^2, default_deceleration: 800 mm/s^2, default_jerk: 5e4 mm/s^3}
  one: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 40 mm}
  two: {type: MC_MoveAbsolute, task: main, Axis: x, Position: 80 mm}
)";

double expected(std::int64_t mode, double v1, double v2) {
    const double velocities[] = {0, 0, std::min(v1, v2), v1, v2, std::max(v1, v2)};
    return velocities[mode];
}

/// The state in which the second motion begins.
MotionState junction(MotionBench& bench) {
    for (int i = 0; i < 10'000 && !bench.is("two.Active"); ++i) bench.step();
    REQUIRE(bench.is("two.Active"));
    CHECK(bench.is("one.Done"));
    return bench.axis("x").point_motion.plan.phases[0].start;
}

MotionState junction(std::int64_t mode, double v1, double v2) {
    MotionBench bench(two_moves);
    bench.set("one.Velocity", v1);
    bench.set("two.Velocity", v2);
    bench.set("two.BufferMode", mode);
    bench.set("one.Execute", true);
    bench.step(30);
    bench.set("two.Execute", true);
    return junction(bench);
}

}  // namespace

TEST_CASE("the end of the first move is passed exactly, with the velocity of the mode to 4 ulp") {
    for (std::int64_t mode = 1; mode < modes; ++mode)
        for (const auto& [v1, v2] : {std::pair{100.0, 50.0}, {50.0, 100.0}, {70.0, 70.0}}) {
            INFO("mode " << mode << ", " << v1 << " then " << v2);
            const MotionState start = junction(mode, v1, v2);
            CHECK(start.position == 40);
            CHECK(start.acceleration == 0);
            const double wanted = expected(mode, v1, v2);
            CHECK(std::abs(start.velocity - wanted) <=
                  4 * std::abs(std::nextafter(wanted, 1e9) - wanted));
        }
}

TEST_CASE("a mode that is aborting goes on from where the axis is") {
    MotionBench bench(two_moves);
    bench.set("one.Execute", true);
    bench.step(200);
    bench.set("two.Execute", true);
    bench.step(2);
    CHECK(bench.is("one.CommandAborted"));
    CHECK(bench.is("two.Active"));
    CHECK(bench.number("x.velocity") > 80);
}

TEST_CASE(
    "what a way is too short for is blended with what can be reached, without turning round") {
    Random random(1, "short ways");
    for (int i = 0; i < 300; ++i) {
        MotionBench bench(two_moves);
        const double first = random.share() * 5, second = random.share() * 5;
        const auto mode = static_cast<std::int64_t>(2 + random.next() % 4);
        bench.set("one.Position", first);
        bench.set("two.Position", first + second);
        bench.set("two.BufferMode", mode);
        bench.set("one.Execute", true);
        bench.set("two.Execute", true);
        INFO("by " << first << " and " << second << ", mode " << mode);
        double last = 0;
        for (int ms = 0; ms < 2000 && !bench.is("two.Done"); ++ms) {
            bench.step();
            REQUIRE(bench.number("x.position") >= last - 1e-12);
            last = bench.number("x.position");
        }
        CHECK(bench.number("x.position") == first + second);
    }
}

TEST_CASE("moves that part at their junction stand there") {
    MotionBench bench(two_moves);
    bench.set("two.Position", 10.0);
    bench.set("two.BufferMode", std::int64_t{5});
    bench.set("one.Execute", true);
    bench.set("two.Execute", true);
    CHECK(junction(bench).velocity == 0);
}

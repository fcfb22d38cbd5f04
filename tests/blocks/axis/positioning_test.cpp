#include "blocks/axis/positioning.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr std::int64_t start = 7 * millisecond;

Positioning planned(double from, double to) {
    Positioning move;
    REQUIRE(move.begin(from, to, 20, 100, 5e3, start) == PlanResult::ok);
    return move;
}

}  // namespace

TEST_CASE("a positioning starts where the axis stands and ends exactly at its target") {
    for (const double to : {10.0, -10.0, 0.1, 1e-9, 1e6}) {
        INFO("to " << to);
        const Positioning move = planned(0.3, to);
        CHECK(move.at(start).position == 0.3);
        CHECK(move.at(start).velocity == 0);
        CHECK_FALSE(move.finished(start));
        const auto end = start + static_cast<std::int64_t>(std::ceil(move.plan.duration * 1e9));
        CHECK(move.finished(end));
        CHECK(move.at(end).position == to);
        CHECK(move.at(end).velocity == 0);
        CHECK(move.at(end).acceleration == 0);
        CHECK_FALSE(move.finished(end - 2));
    }
}

TEST_CASE("a positioning there and one back mirror each other") {
    const Positioning there = planned(0, 8), back = planned(0, -8);
    for (std::int64_t t = start; t < start + 600 * millisecond; t += 7 * millisecond) {
        const MotionState a = there.at(t), b = back.at(t);
        CHECK(a.position == -b.position);
        CHECK(a.velocity == -b.velocity);
        CHECK(a.acceleration == -b.acceleration);
        CHECK(a.velocity >= 0);
        CHECK(a.velocity <= 20);
    }
}

TEST_CASE("a positioning to where the axis stands is finished at once") {
    const Positioning move = planned(3, 3);
    CHECK(move.finished(start));
    CHECK(move.at(start).position == 3);
}

TEST_CASE("a positioning with velocities at its ends keeps the one that it ends with") {
    for (const double sign : {1.0, -1.0}) {
        Positioning move;
        REQUIRE(move.begin({.position = 2, .velocity = sign * 5}, 2 + sign * 10,
                           {.Ve = 8, .Vm = 20, .A = 100, .J = 5e3}, start) == PlanResult::ok);
        CHECK(move.at(start).position == 2);
        CHECK(move.at(start).velocity == sign * 5);
        const auto end = start + static_cast<std::int64_t>(std::ceil(move.plan.duration * 1e9));
        CHECK(std::abs(move.at(end).position - (2 + sign * 10)) <= 8 * 1e-9);
        for (const std::int64_t later : {end, end + millisecond, end + 5000 * millisecond}) {
            const double late = seconds(later - start) - move.plan.duration;
            CHECK(move.at(later).velocity == sign * 8);
            CHECK(move.at(later).acceleration == 0);
            CHECK(move.at(later).position == 2 + sign * 10 + sign * 8 * late);
        }
    }
}

TEST_CASE("a positioning from any state joins it and ends exactly at its target") {
    for (const MotionState& from : {MotionState{.velocity = 1}, MotionState{.velocity = 30},
                                    MotionState{.velocity = 5, .acceleration = 40},
                                    MotionState{.velocity = -5, .acceleration = -70}}) {
        Positioning move;
        const SevenSegment limits{.Vm = 20, .A = 100, .J = 5e3};
        REQUIRE(move.begin(from, -3, limits, start) == PlanResult::ok);
        CHECK(move.from_any_state);
        CHECK(move.at(start).velocity == from.velocity);
        CHECK(move.at(start).acceleration == from.acceleration);
        const auto end = start + static_cast<std::int64_t>(std::ceil(move.duration() * 1e9));
        CHECK(move.finished(end));
        CHECK(move.at(end).position == -3);
        CHECK(move.at(end).velocity == 0);
    }
}

TEST_CASE("a positioning that cannot be planned leaves the one before it") {
    Positioning move = planned(0, 8);
    CHECK(move.begin(0, 9, 0, 100, 5e3, start) == PlanResult::limit_not_positive);
    CHECK(move.begin(0, 9, 20, -1, 5e3, start) == PlanResult::limit_not_positive);
    CHECK(move.begin(0, not_a_number, 20, 100, 5e3, start) == PlanResult::not_finite);
    CHECK(move.begin(-largest, largest, 20, 100, 5e3, start) == PlanResult::not_finite);
    CHECK(move.target == 8);
    CHECK(move.at(start + 100 * 1000 * millisecond).position == 8);
}

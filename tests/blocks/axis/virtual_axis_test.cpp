#include "blocks/axis/virtual_axis.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// Of the time within a ramp, a difference of times below 1 s [s].
constexpr double rounding = 4 * epsilon;

VirtualAxis absolute(bool immediate) {
    VirtualAxis axis;
    axis.motion = VirtualAxis::Motion::absolute;
    axis.immediate = immediate;
    axis.wanted_velocity = 10;
    return axis;
}

void start_move(VirtualAxis& axis, Clock& clock, double target) {
    axis.execute = false;
    clock.scan(axis);
    axis.target = target;
    axis.execute = true;
    clock.scan(axis);
}

/// Scans until `done`, or too many times.
void finish_move(VirtualAxis& axis, Clock& clock) {
    for (int i = 0; i < 100'000 && !axis.done; ++i) clock.scan(axis);
    REQUIRE(axis.done);
}

void check_finite(const VirtualAxis& axis) {
    REQUIRE(std::isfinite(axis.position));
    REQUIRE(std::isfinite(axis.velocity));
    REQUIRE(std::isfinite(axis.acceleration));
}

}  // namespace

TEST_CASE("an axis in velocity mode ramps to its velocity by an S-curve and holds it") {
    VirtualAxis axis;
    axis.start_position = 3;
    axis.wanted_velocity = 20;
    Clock clock{.interval = 100 * microsecond};
    clock.scan(axis);
    CHECK(axis.position == 3);
    CHECK(axis.velocity == 0);
    const double T = ramp_duration(20, 100, 5e4);
    double v = 0, a = 0;
    while (clock.time() < 400 * millisecond) {
        const double t = seconds(clock.time());
        clock.scan(axis);
        REQUIRE(axis.moving);
        REQUIRE(axis.velocity - v <= 100 * (1e-4 + rounding) + 4 * epsilon * 20);
        REQUIRE(std::abs(axis.acceleration - a) <= 5e4 * (1e-4 + rounding) + 4 * epsilon * 100);
        REQUIRE((axis.velocity == 20) == (t >= T));
        v = axis.velocity;
        a = axis.acceleration;
    }
    const double t = seconds(clock.time() - clock.interval);
    CHECK(std::abs(axis.position - (3 + 20 * (t - T) + 20 * T / 2)) <= 16 * epsilon * 10);
}

TEST_CASE("a velocity changed in mid-ramp leaves no step") {
    for (const double second : {30.0, 10.0, 0.0, -15.0}) {
        INFO("second velocity " << second);
        VirtualAxis axis;
        axis.wanted_velocity = 20;
        Clock clock{.interval = 50 * microsecond};
        while (clock.time() < 100 * millisecond) clock.scan(axis);
        VirtualAxis unchanged = axis;
        Clock other = clock;
        axis.wanted_velocity = second;
        clock.scan(axis);
        other.scan(unchanged);
        CHECK(axis.position == unchanged.position);
        CHECK(axis.velocity == unchanged.velocity);
        CHECK(axis.acceleration == unchanged.acceleration);
        double v = axis.velocity, a = axis.acceleration;
        while (clock.time() < 600 * millisecond) {
            clock.scan(axis);
            REQUIRE(std::abs(axis.velocity - v) <= 100 * (5e-5 + rounding) + 4 * epsilon * 30);
            REQUIRE(std::abs(axis.acceleration - a) <= 5e4 * (5e-5 + rounding) + 4 * epsilon * 100);
            v = axis.velocity;
            a = axis.acceleration;
        }
        CHECK(axis.velocity == second);
        CHECK(axis.moving == (second != 0));
    }
}

TEST_CASE("without enable the axis ramps to standstill, with it to its velocity again") {
    VirtualAxis axis;
    axis.wanted_velocity = 10;
    axis.enable = false;
    Clock clock;
    for (int i = 0; i < 10; ++i) clock.scan(axis);
    CHECK(axis.position == 0);
    CHECK_FALSE(axis.moving);
    axis.enable = true;
    while (clock.time() < 300 * millisecond) clock.scan(axis);
    CHECK(axis.velocity == 10);
    axis.enable = false;
    clock.scan(axis);
    CHECK(axis.velocity == 10);
    clock.scan(axis);
    CHECK(axis.velocity < 10);
    CHECK(axis.velocity > 9.9);
    while (clock.time() < 600 * millisecond) clock.scan(axis);
    CHECK(axis.velocity == 0);
    CHECK_FALSE(axis.moving);
    const double stood = axis.position;
    clock.scan(axis);
    CHECK(axis.position == stood);
}

TEST_CASE("an immediate axis has its velocity at once, from the scan that sees it") {
    VirtualAxis axis;
    axis.immediate = true;
    Clock clock;
    clock.scan(axis);
    axis.wanted_velocity = 10;
    clock.scan(axis);
    CHECK(axis.velocity == 10);
    CHECK(axis.position == 0);
    clock.scan(axis);
    CHECK(axis.position == 10 * seconds(millisecond));
    axis.wanted_velocity = -5;
    clock.scan(axis);
    CHECK(axis.velocity == -5);
    CHECK(axis.acceleration == 0);
    CHECK(axis.position == 10 * seconds(2 * millisecond));
}

TEST_CASE("positions at constant velocity come from the time, not from summing up") {
    VirtualAxis axis;
    axis.immediate = true;
    axis.wanted_velocity = 0.1;
    Clock clock;
    for (int i = 0; i <= 1'000'000; ++i) clock.scan(axis);
    CHECK(axis.position == 0.1 * 1000.0);
}

TEST_CASE("an absolute move ends exactly at its target") {
    for (const bool immediate : {true, false}) {
        for (const double target : {6.283185307179586, -6.283185307179586, 0.1, 1e-12}) {
            INFO((immediate ? "immediate" : "S-curve") << " to " << target);
            VirtualAxis axis = absolute(immediate);
            Clock clock;
            start_move(axis, clock, target);
            CHECK_FALSE(axis.done);
            double last = 0;
            while (!axis.done) {
                REQUIRE(std::abs(axis.position) <= std::abs(target));
                REQUIRE(std::abs(axis.position) >= last);
                REQUIRE(std::abs(axis.velocity) <= 10);
                REQUIRE(clock.time() < 2000 * millisecond);
                last = std::abs(axis.position);
                clock.scan(axis);
            }
            CHECK(axis.position == target);
            CHECK(axis.velocity == 0);
            CHECK_FALSE(axis.moving);
            clock.scan(axis);
            CHECK(axis.done);
            CHECK(axis.position == target);
        }
    }
}

TEST_CASE("an immediate move takes its length over its velocity") {
    VirtualAxis axis = absolute(true);
    Clock clock;
    start_move(axis, clock, 1);
    const std::int64_t start = clock.time() - clock.interval;
    CHECK(axis.moving);
    CHECK(axis.velocity == 10);
    while (!axis.done) clock.scan(axis);
    CHECK(clock.time() - clock.interval - start == 100 * millisecond);
}

TEST_CASE("a move of no length is done at once") {
    for (const bool immediate : {true, false}) {
        VirtualAxis axis = absolute(immediate);
        axis.start_position = 2;
        Clock clock;
        start_move(axis, clock, 2);
        CHECK(axis.done);
        CHECK_FALSE(axis.moving);
        CHECK(axis.position == 2);
    }
}

TEST_CASE("a second move starts from the first one's target") {
    for (const bool immediate : {true, false}) {
        VirtualAxis axis = absolute(immediate);
        Clock clock;
        start_move(axis, clock, 1);
        finish_move(axis, clock);
        axis.execute = false;
        clock.scan(axis);
        CHECK(axis.done);
        axis.target = -0.5;
        axis.execute = true;
        clock.scan(axis);
        CHECK_FALSE(axis.done);
        CHECK(axis.position == 1);
        finish_move(axis, clock);
        CHECK(axis.position == -0.5);
    }
}

TEST_CASE("a move keeps the target that it was started with") {
    for (const bool immediate : {true, false}) {
        VirtualAxis axis = absolute(immediate);
        Clock clock;
        start_move(axis, clock, 1);
        axis.target = 7;
        finish_move(axis, clock);
        CHECK(axis.position == 1);
        clock.scan(axis);
        CHECK(axis.position == 1);
    }
}

TEST_CASE("a move under way goes on when execute falls, and stops without enable") {
    for (const bool immediate : {true, false}) {
        VirtualAxis axis = absolute(immediate);
        Clock clock;
        start_move(axis, clock, 5);
        axis.execute = false;
        for (int i = 0; i < 200; ++i) clock.scan(axis);
        CHECK(axis.velocity > 5);
        axis.enable = false;
        const double velocity = axis.velocity;
        clock.scan(axis);
        clock.scan(axis);
        CHECK(axis.velocity < velocity);
        for (int i = 0; i < 300; ++i) clock.scan(axis);
        CHECK_FALSE(axis.moving);
        CHECK_FALSE(axis.done);
        CHECK(axis.position < 5);
    }
}

TEST_CASE("an immediate axis takes a new target in mid-move") {
    VirtualAxis axis = absolute(true);
    Clock clock;
    start_move(axis, clock, 1);
    for (int i = 0; i < 20; ++i) clock.scan(axis);
    const double turned_at = axis.position;
    start_move(axis, clock, -1);
    CHECK(axis.velocity == -10);
    CHECK(axis.position > turned_at);
    finish_move(axis, clock);
    CHECK(axis.position == -1);
}

TEST_CASE("a move to where a moving immediate axis is stops it there") {
    VirtualAxis axis = absolute(true);
    Clock clock;
    start_move(axis, clock, 1);
    for (int i = 0; i < 20; ++i) clock.scan(axis);
    VirtualAxis ahead = axis;
    ahead.execute = false;
    Clock later = clock;
    later.scan(ahead);
    later.scan(ahead);
    start_move(axis, clock, ahead.position);
    CHECK(axis.done);
    CHECK_FALSE(axis.moving);
    for (int i = 0; i < 5; ++i) clock.scan(axis);
    CHECK(axis.position == ahead.position);
}

TEST_CASE("a move by S-curve takes a new target in mid-move, without a step") {
    for (const double target : {2.0, 9.0, -3.0}) {
        VirtualAxis axis = absolute(false);
        Clock clock;
        start_move(axis, clock, 5);
        for (int i = 0; i < 100; ++i) clock.scan(axis);
        REQUIRE(axis.moving);
        const double acceleration = axis.acceleration, velocity = axis.velocity;
        start_move(axis, clock, target);
        CHECK_FALSE(axis.error);
        CHECK_FALSE(axis.done);
        CHECK(std::abs(axis.acceleration - acceleration) <= axis.jerk_limit * 2.001e-3);
        CHECK(std::abs(axis.velocity - velocity) <= axis.acceleration_limit * 2.001e-3);
        finish_move(axis, clock);
        CHECK(axis.position == target);
        CHECK(axis.velocity == 0);
    }
}

TEST_CASE("a move without enable is refused, and not made up for") {
    for (const bool immediate : {true, false}) {
        VirtualAxis axis = absolute(immediate);
        axis.enable = false;
        Clock clock;
        start_move(axis, clock, 5);
        CHECK(axis.error);
        CHECK(axis.error_id == AxisError::not_enabled);
        axis.enable = true;
        for (int i = 0; i < 10; ++i) clock.scan(axis);
        CHECK_FALSE(axis.error);
        CHECK(axis.position == 0);
        start_move(axis, clock, 5);
        finish_move(axis, clock);
        CHECK(axis.position == 5);
    }
}

TEST_CASE("limits that change in mid-ramp count from the next change of velocity on") {
    VirtualAxis axis;
    axis.wanted_velocity = 10;
    Clock clock;
    for (int i = 0; i < 20; ++i) clock.scan(axis);
    VirtualAxis changed = axis;
    Clock other = clock;
    changed.acceleration_limit = 10;
    changed.jerk_limit = 100;
    while (axis.acceleration != 0) {
        clock.scan(axis);
        other.scan(changed);
        REQUIRE(changed.velocity == axis.velocity);
    }
    changed.wanted_velocity = 20;
    for (int i = 0; i < 500; ++i) {
        other.scan(changed);
        REQUIRE(changed.acceleration <= 10 * (1 + 4 * epsilon));
    }
    CHECK(changed.acceleration == Approx(10));
}

TEST_CASE("home sets the position of a standing axis only") {
    VirtualAxis axis;
    axis.home_position = -7;
    axis.home = true;
    Clock clock;
    clock.scan(axis);
    CHECK(axis.position == -7);
    axis.home_position = 3;
    clock.scan(axis);
    CHECK(axis.position == -7);
    axis.home = false;
    axis.wanted_velocity = 10;
    for (int i = 0; i < 300; ++i) clock.scan(axis);
    const double before = axis.position;
    axis.home = true;
    clock.scan(axis);
    CHECK(axis.position > before);
    axis.home = false;
    axis.wanted_velocity = 0;
    for (int i = 0; i < 300; ++i) clock.scan(axis);
    axis.home = true;
    clock.scan(axis);
    CHECK(axis.position == 3);
}

TEST_CASE("home and execute in one scan move from the new position") {
    VirtualAxis axis = absolute(true);
    Clock clock;
    clock.scan(axis);
    axis.home = axis.execute = true;
    axis.home_position = 4;
    axis.target = 3;
    clock.scan(axis);
    CHECK(axis.position == 4);
    CHECK(axis.velocity == -10);
    finish_move(axis, clock);
    CHECK(axis.position == 3);
}

TEST_CASE("inputs that are no numbers, or no limits, hold a virtual axis and are named") {
    struct Bad {
        double VirtualAxis::*input;
        double value;
        AxisError error;
    };
    const Bad all[] = {{&VirtualAxis::wanted_velocity, not_a_number, AxisError::not_finite},
                       {&VirtualAxis::wanted_velocity, infinite, AxisError::not_finite},
                       {&VirtualAxis::target, not_a_number, AxisError::not_finite},
                       {&VirtualAxis::home_position, -infinite, AxisError::not_finite},
                       {&VirtualAxis::acceleration_limit, not_a_number, AxisError::not_finite},
                       {&VirtualAxis::acceleration_limit, 0, AxisError::limit_not_positive},
                       {&VirtualAxis::jerk_limit, -5, AxisError::limit_not_positive}};
    for (const Bad& bad : all) {
        INFO("input " << &bad - all);
        VirtualAxis axis;
        axis.wanted_velocity = 10;
        Clock clock;
        for (int i = 0; i < 300; ++i) clock.scan(axis);
        const VirtualAxis good = axis;
        axis.*bad.input = bad.value;
        for (int i = 0; i < 3; ++i) {
            clock.scan(axis);
            CHECK(axis.error);
            CHECK(axis.error_id == bad.error);
            CHECK(axis.position == good.position);
            CHECK(axis.velocity == good.velocity);
        }
        axis.*bad.input = good.*bad.input;
        clock.scan(axis);
        CHECK_FALSE(axis.error);
        CHECK(axis.position > good.position);
    }
}

TEST_CASE("a move with a velocity that is not above 0 is refused") {
    for (const double velocity : {0.0, -10.0}) {
        VirtualAxis axis = absolute(true);
        axis.wanted_velocity = velocity;
        Clock clock;
        start_move(axis, clock, 1);
        CHECK(axis.error_id == AxisError::limit_not_positive);
        CHECK(axis.position == 0);
    }
}

TEST_CASE("extreme but finite inputs never make an output that is no number") {
    const double extremes[] = {1e300, -1e300, largest, -largest, denormal, -denormal, -0.0, 1};
    for (const bool immediate : {true, false}) {
        for (const bool moves : {true, false}) {
            for (const double velocity : extremes) {
                for (const double place : extremes) {
                    INFO("velocity " << velocity << " place " << place);
                    VirtualAxis axis = moves ? absolute(immediate) : VirtualAxis{};
                    axis.immediate = immediate;
                    axis.wanted_velocity = velocity;
                    axis.start_position = place;
                    Clock clock{.interval = 3600 * 1000 * millisecond};
                    for (int i = 0; i < 20; ++i) {
                        axis.target = i % 4 < 2 ? -place : place;
                        axis.execute = i % 2 == 1;
                        if (i == 10) axis.wanted_velocity = -velocity;
                        clock.scan(axis);
                        check_finite(axis);
                    }
                }
            }
        }
    }
}

TEST_CASE("an axis that ran out of a double's range follows good inputs again") {
    VirtualAxis axis;
    axis.immediate = true;
    axis.wanted_velocity = largest;
    Clock clock{.interval = 1000 * millisecond};
    for (int i = 0; i < 5; ++i) clock.scan(axis);
    CHECK(axis.error);
    CHECK(axis.error_id == AxisError::not_finite);
    const double held = axis.position;
    axis.wanted_velocity = 0;
    clock.scan(axis);
    CHECK_FALSE(axis.error);
    CHECK(axis.position == held);
    CHECK(axis.velocity == 0);
}

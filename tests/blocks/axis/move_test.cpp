#include "blocks/axis/move.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr double limit_v = 80, limit_a = 500, limit_j = 5000;

Move axis_at(double position, double velocity = 0) {
    Move axis;
    axis.start_position = position;
    axis.start_velocity = velocity;
    axis.velocity_limit = limit_v;
    axis.acceleration_limit = limit_a;
    axis.jerk_limit = limit_j;
    return axis;
}

/// The scan that sees a rising edge of `execute`.
void start(Move& axis, Clock& clock, double target, double end_velocity = 0) {
    if (axis.execute) {
        axis.execute = false;
        clock.scan(axis);
    }
    axis.target = target;
    axis.end_velocity = end_velocity;
    axis.execute = true;
    clock.scan(axis);
}

/// Scans until `done`, or too many times.
void finish(Move& axis, Clock& clock) {
    for (int i = 0; i < 100'000 && !axis.done; ++i) clock.scan(axis);
    REQUIRE(axis.done);
}

void check_exclusive(const Move& axis) {
    REQUIRE(axis.busy + axis.done + axis.error <= 1);
    REQUIRE(axis.error == (axis.error_id != MoveError::none));
}

void check_finite(const Move& axis) {
    REQUIRE(all_finite(axis.position, axis.velocity, axis.acceleration, axis.jerk, axis.duration));
    REQUIRE(
        all_finite(axis.displacement_error, axis.greatest_velocity, axis.greatest_acceleration));
}

}  // namespace

TEST_CASE("a move from rest to rest keeps its limits and ends exactly at its target") {
    for (const double target : {30.0, -30.0, 0.31, 0.3 - 1e-9, 1e4}) {
        INFO("target " << target);
        Move axis = axis_at(0.3);
        Clock clock;
        clock.scan(axis);
        CHECK_FALSE(axis.busy);
        CHECK_FALSE(axis.done);
        const std::int64_t begin = clock.time();
        start(axis, clock, target);
        CHECK(axis.position == 0.3);
        CHECK(axis.velocity == 0);
        CHECK(std::abs(axis.jerk) == limit_j);
        while (axis.busy) {
            REQUIRE(seconds(clock.time() - clock.interval - begin) < axis.duration);
            REQUIRE(std::abs(axis.velocity) <= axis.greatest_velocity * (1 + 4 * epsilon));
            REQUIRE(std::abs(axis.acceleration) <= axis.greatest_acceleration * (1 + 4 * epsilon));
            REQUIRE(std::abs(axis.jerk) <= limit_j);
            REQUIRE(axis.velocity * (target - 0.3) >= 0);
            check_exclusive(axis);
            clock.scan(axis);
        }
        CHECK(axis.done);
        CHECK(axis.in_end_velocity);
        CHECK(seconds(clock.time() - clock.interval - begin) >= axis.duration);
        CHECK(axis.position == target);
        CHECK(axis.velocity == 0);
        CHECK(axis.acceleration == 0);
        CHECK(axis.jerk == 0);
        CHECK_FALSE(std::signbit(axis.velocity));
        CHECK(axis.greatest_velocity <= limit_v);
        CHECK(axis.greatest_acceleration <= limit_a);
        CHECK(axis.displacement_error <= 4 * epsilon * std::abs(target - 0.3));
    }
}

TEST_CASE("each scan's state is the one before and its jerk") {
    Move axis = axis_at(0);
    Clock clock;
    start(axis, clock, 30);
    while (axis.busy) {
        const double v = axis.velocity, a = axis.acceleration, x = axis.position;
        clock.scan(axis);
        REQUIRE(std::abs(axis.acceleration - a) <= limit_j * 1e-3 * (1 + 1e-12));
        REQUIRE(std::abs(axis.velocity - v) <= limit_a * 1e-3 * (1 + 1e-12));
        REQUIRE(axis.position - x <= limit_v * 1e-3 * (1 + 1e-12));
        REQUIRE(std::abs((axis.velocity + v) / 2 * 1e-3 - (axis.position - x)) <=
                2 * limit_j * 1e-9);
    }
}

TEST_CASE("moves there and back mirror each other") {
    Move there = axis_at(0, 10), back = axis_at(0, -10);
    Clock clock, other;
    start(there, clock, 25, 20);
    start(back, other, -25, 20);
    for (int i = 0; i < 1000; ++i) {
        clock.scan(there);
        other.scan(back);
        REQUIRE(there.position == -back.position);
        REQUIRE(there.velocity == -back.velocity);
        REQUIRE(there.acceleration == -back.acceleration);
        REQUIRE(there.jerk == -back.jerk);
        REQUIRE(there.done == back.done);
    }
    CHECK(there.done);
    CHECK(there.velocity == 20);
}

TEST_CASE("after an end velocity the axis moves on, from the target at the move's end") {
    Move axis = axis_at(5);
    Clock clock;
    const double begin = seconds(clock.time());
    start(axis, clock, 40, 30);
    finish(axis, clock);
    CHECK(axis.in_end_velocity);
    for (int i = 0; i < 5000; ++i) {
        const double late = seconds(clock.time()) - begin - axis.duration;
        clock.scan(axis);
        REQUIRE(axis.velocity == 30);
        REQUIRE(axis.acceleration == 0);
        REQUIRE(std::abs(axis.position - (40 + 30 * late)) <= 4 * epsilon * 200);
    }
    CHECK(axis.done);
    start(axis, clock, 400);
    finish(axis, clock);
    CHECK(axis.position == 400);
    CHECK(axis.velocity == 0);
}

TEST_CASE("a way too short for the end velocity is passed at what can be reached") {
    Move axis = axis_at(0, 60);
    Clock clock;
    start(axis, clock, 2);
    finish(axis, clock);
    CHECK_FALSE(axis.in_end_velocity);
    CHECK(axis.kind == MoveKind::decelerate_triangular);
    CHECK(axis.velocity > 0);
    CHECK(axis.velocity < 60);
    CHECK(axis.position > 2);
    const double velocity = axis.velocity;
    clock.scan(axis);
    CHECK(axis.velocity == velocity);
}

TEST_CASE("before its first move the axis runs at its start velocity") {
    Move axis = axis_at(3, -20);
    Clock clock;
    for (int i = 0; i < 1000; ++i) {
        const double t = seconds(clock.time());
        clock.scan(axis);
        REQUIRE(axis.position == 3 - 20 * t);
        REQUIRE(axis.velocity == -20);
    }
    CHECK_FALSE(axis.busy);
    CHECK_FALSE(axis.done);
    CHECK_FALSE(axis.in_end_velocity);
    CHECK(axis.equation == 0);
}

TEST_CASE("a move of no length is done in the scan that sees it") {
    for (const double velocity : {0.0, 20.0, -20.0}) {
        INFO("velocity " << velocity);
        Move axis = axis_at(7, velocity);
        Clock clock;
        start(axis, clock, 7, 20);
        CHECK(axis.done);
        CHECK(axis.position == 7);
        CHECK(axis.velocity == velocity);
        CHECK(axis.duration == 0);
        CHECK(axis.in_end_velocity == (velocity != 0));
        clock.scan(axis);
        CHECK(axis.position == Approx(7 + velocity * 1e-3));
    }
}

TEST_CASE("done lasts until execute falls, one scan at least") {
    Move held = axis_at(0);
    Clock clock;
    start(held, clock, 1);
    finish(held, clock);
    for (int i = 0; i < 3; ++i) {
        clock.scan(held);
        CHECK(held.done);
    }
    held.execute = false;
    clock.scan(held);
    CHECK_FALSE(held.done);
    CHECK(held.in_end_velocity);

    Move fallen = axis_at(0);
    start(fallen, clock, 1);
    fallen.execute = false;
    finish(fallen, clock);
    clock.scan(fallen);
    CHECK_FALSE(fallen.done);
    CHECK_FALSE(fallen.busy);
    CHECK(fallen.position == 1);
}

TEST_CASE("a move keeps the inputs that it was started with") {
    Move axis = axis_at(0), same = axis_at(0);
    Clock clock, other;
    start(axis, clock, 20);
    start(same, other, 20);
    axis.target = -5;
    axis.velocity_limit = 1;
    axis.acceleration_limit = 1;
    axis.jerk_limit = 1;
    axis.end_velocity = 1;
    for (int i = 0; i < 1000; ++i) {
        clock.scan(axis);
        other.scan(same);
        REQUIRE(axis.position == same.position);
    }
    CHECK(axis.done);
}

TEST_CASE("a move in the cruise of another starts from there and leaves no step") {
    Move axis = axis_at(0);
    Clock clock;
    start(axis, clock, 60);
    while (axis.acceleration != 0 || axis.velocity != limit_v) clock.scan(axis);
    axis.execute = false;
    clock.scan(axis);
    REQUIRE(axis.velocity == limit_v);
    const double before = axis.position;
    start(axis, clock, 200, 10);
    CHECK(axis.busy);
    CHECK(axis.velocity == limit_v);
    CHECK(axis.position - before == Approx(limit_v * 1e-3));
    finish(axis, clock);
    CHECK(axis.velocity == 10);
    CHECK(axis.position >= 200);
    CHECK(axis.position <= 200 + 10 * 1e-3);
}

TEST_CASE("a move starts in any state of another, without a step, and ends at its target") {
    for (int scans = 1; scans < 600; scans += 7) {
        for (const double target : {100.0, 60.0, 3.0, -40.0}) {
            INFO("to " << target << " after " << scans << " scans");
            Move axis = axis_at(0);
            Clock clock;
            start(axis, clock, 60);
            for (int i = 0; i < scans; ++i) clock.scan(axis);
            const MotionState before{axis.position, axis.velocity, axis.acceleration, 0};
            start(axis, clock, target);
            REQUIRE_FALSE(axis.error);
            check_exclusive(axis);
            REQUIRE(std::abs(axis.acceleration - before.acceleration) <=
                    axis.jerk_limit * 2.001e-3);
            REQUIRE(axis.greatest_velocity <= axis.velocity_limit * (1 + 1e-12));
            REQUIRE(axis.greatest_acceleration <= axis.acceleration_limit * (1 + 1e-12));
            for (int i = 0; axis.busy && i < 100000; ++i) {
                clock.scan(axis);
                REQUIRE(std::abs(axis.velocity) <= axis.velocity_limit * (1 + 1e-12));
            }
            REQUIRE(axis.done);
            REQUIRE(axis.position == target);
            REQUIRE(axis.velocity == 0);
        }
    }
}

TEST_CASE("a move in mid-ramp is planned from that state; where it starts is no equation") {
    Move axis = axis_at(0);
    Clock clock;
    start(axis, clock, 60);
    for (int i = 0; i < 20; ++i) clock.scan(axis);
    REQUIRE(axis.acceleration != 0);
    start(axis, clock, 100, 30);
    CHECK(axis.kind == MoveKind::from_any_state);
    CHECK(axis.equation == 0);
    CHECK(axis.displacement_error < 1e-12);
    while (axis.busy) clock.scan(axis);
    CHECK(axis.in_end_velocity);
    CHECK(axis.velocity == 30);
    CHECK(axis.position >= 100);
}

TEST_CASE("a move against the axis' motion turns round; one below its velocity slows down") {
    Move axis = axis_at(0, 20);
    Clock clock;
    start(axis, clock, -1);
    CHECK_FALSE(axis.error);
    while (axis.busy) clock.scan(axis);
    CHECK(axis.position == -1);

    Move slow = axis_at(0, 20);
    Clock other;
    slow.velocity_limit = 10;
    start(slow, other, 50);
    CHECK_FALSE(slow.error);
    CHECK(slow.greatest_velocity == 20);
    while (slow.busy) {
        other.scan(slow);
        if (slow.position < 45 && slow.position > 10) CHECK(slow.velocity == Approx(10));
    }
    CHECK(slow.position == 50);
}

TEST_CASE("an end velocity outside its limit is refused, in any state") {
    for (const double velocity : {20.0, -20.0}) {
        Move axis = axis_at(0, velocity);
        Clock clock;
        axis.velocity_limit = 40;
        for (const double end : {41.0, -1.0}) {
            start(axis, clock, 50, end);
            CHECK(axis.error_id == MoveError::velocity_above_limit);
            CHECK(axis.velocity == velocity);
        }
        start(axis, clock, 50, 40);
        CHECK_FALSE(axis.error);
        CHECK(axis.busy);
    }
}

TEST_CASE("inputs that are no numbers, or no limits, hold a move and are named") {
    using Input = double Move::*;
    for (const Input input : {&Move::target, &Move::velocity_limit, &Move::acceleration_limit,
                              &Move::jerk_limit, &Move::end_velocity}) {
        for (const double bad : {not_a_number, infinite, -infinite}) {
            Move axis = axis_at(0), same = axis_at(0);
            Clock clock, other;
            start(axis, clock, 20);
            start(same, other, 20);
            const Move held = axis;
            const double good = axis.*input;
            axis.*input = bad;
            clock.scan(axis);
            other.scan(same);
            CHECK(axis.error_id == MoveError::not_finite);
            CHECK(axis.position == held.position);
            CHECK(axis.jerk == held.jerk);
            check_exclusive(axis);
            axis.*input = good;
            clock.scan(axis);
            other.scan(same);
            CHECK(axis.busy);
            CHECK(axis.position == same.position);
        }
    }
    for (const Input limit :
         {&Move::velocity_limit, &Move::acceleration_limit, &Move::jerk_limit}) {
        for (const double bad : {0.0, -1.0}) {
            Move axis = axis_at(0);
            axis.*limit = bad;
            Clock clock;
            start(axis, clock, 20);
            CHECK(axis.error_id == MoveError::limit_not_positive);
            CHECK(axis.position == 0);
        }
    }
}

TEST_CASE("an edge of execute beside a bad input counts when the input is good") {
    Move axis = axis_at(2);
    Clock clock;
    start(axis, clock, not_a_number);
    CHECK(axis.error);
    CHECK(axis.position == 2);
    axis.target = 3;
    clock.scan(axis);
    CHECK_FALSE(axis.error);
    finish(axis, clock);
    CHECK(axis.position == 3);
}

TEST_CASE("extreme but finite inputs never make an output of a move that is no number") {
    const double extremes[] = {1e300, -1e300, largest, -largest, denormal, -denormal, -0.0, 1};
    for (const double velocity : extremes) {
        for (const double place : extremes) {
            for (const double limit : extremes) {
                INFO("velocity " << velocity << " place " << place << " limit " << limit);
                Move axis = axis_at(place, velocity);
                axis.acceleration_limit = std::abs(limit);
                axis.jerk_limit = std::abs(velocity);
                axis.velocity_limit = std::abs(limit);
                Clock clock{.interval = 3600 * 1000 * millisecond};
                for (int i = 0; i < 12; ++i) {
                    axis.target = i % 4 < 2 ? -place : place;
                    axis.execute = i % 2 == 1;
                    axis.end_velocity = i % 3 == 0 ? 0 : std::abs(velocity);
                    clock.scan(axis);
                    check_finite(axis);
                    check_exclusive(axis);
                }
            }
        }
    }
}

TEST_CASE("the cycle does not change a move") {
    Move fine = axis_at(0), coarse = axis_at(0);
    Clock fast{.interval = 100 * microsecond}, slow{.interval = 5 * millisecond};
    start(fine, fast, 30, 20);
    start(coarse, slow, 30, 20);
    while (coarse.busy) {
        slow.scan(coarse);
        for (int i = 0; i < 50; ++i) fast.scan(fine);
        REQUIRE(coarse.position == fine.position);
        REQUIRE(coarse.velocity == fine.velocity);
    }
    CHECK(coarse.displacement_error == fine.displacement_error);
    CHECK(coarse.duration == fine.duration);
}

TEST_CASE("a way too short for the end velocity takes its time in either direction") {
    for (const double sign : {1.0, -1.0}) {
        INFO("direction " << sign);
        Move axis;
        axis.velocity_limit = 50;
        axis.acceleration_limit = 100;
        axis.jerk_limit = 100;
        Clock clock;
        clock.scan(axis);
        start(axis, clock, sign * 10, 40);
        CHECK(axis.position == 0);
        CHECK(axis.busy);
        CHECK(axis.duration == Approx(2 * std::cbrt(0.1)));  // J s^3 = L, eq. (13) with Vs = 0
        finish(axis, clock);
        CHECK_FALSE(axis.in_end_velocity);
        CHECK(axis.velocity == Approx(sign * 100 * std::pow(0.1, 2.0 / 3)));
    }
}

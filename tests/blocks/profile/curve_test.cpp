#include "blocks/profile/curve.hpp"

#include <cmath>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "tests/blocks/profile/oracle.hpp"

using namespace lineshaft;
using oracle::Random;

TEST_CASE("a polynomial's range is what it comes to, at its ends and where it turns") {
    Random random{7};
    for (int n = 0; n < 2000; ++n) {
        Polynomial<7> p;
        for (double& c : p.c) c = random.between(-1, 1);
        const Range r = range(p, -1.5, 1.2);
        double least = HUGE_VAL, greatest = -HUGE_VAL;
        for (int i = 0; i <= 2000; ++i) {
            const double y = p.at(-1.5 + 2.7 * i / 2000);
            least = std::min(least, y);
            greatest = std::max(greatest, y);
        }
        INFO("polynomial " << n);
        CHECK(r.least <= least + 1e-12);
        CHECK(r.greatest >= greatest - 1e-12);
        CHECK(r.least >= least - 1e-3);
        CHECK(r.greatest <= greatest + 1e-3);
    }
}

TEST_CASE("a curve meets both ends with position, slope and bend, in both directions") {
    Random random{11};
    for (int n = 0; n < 2000; ++n) {
        const double length = random.sign() * random.decades(-1, 3);
        const CurvePoint from{random.between(-1e3, 1e3), random.between(-3, 3),
                              random.between(-1, 1) / std::abs(length), 0};
        const CurvePoint to{random.between(-1e3, 1e3), random.between(-3, 3), 0, 0};
        const SyncCurve curve = SyncCurve::between(100, length, from, to);
        const CurvePoint first = curve.at(100), last = curve.at(100 + length);
        INFO("curve " << n << ", length " << length);
        CHECK(first.y == from.y);
        CHECK(std::abs(first.slope - from.slope) <= 1e-12);
        CHECK(std::abs(first.bend - from.bend) <= 1e-12 / length / length);
        CHECK(std::abs(last.y - to.y) <= 1e-10);  // a rounding of terms up to 15 times as great
        CHECK(std::abs(last.slope - to.slope) <= 1e-9);
    }
}

TEST_CASE("what a curve makes of its limits is what a fine look at the motion finds") {
    int refused = 0;
    for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
        Random random{seed};
        const double length = random.decades(0, 2), v = random.decades(0, 2);
        const double a = random.one_in(2) ? 0 : random.between(-0.45, 1) * v * v / length;
        const MotionState master{0, v, a, 0};
        const CurvePoint from{0, random.between(0, 1), 0, 0},
            to{random.between(0, 1.5) * length, 1, 0, 0};
        const SyncCurve curve = SyncCurve::between(0, length, from, to);
        double most_v = 0, most_a = 0, most_j = 0;
        for (int i = 0; i <= 4000; ++i) {
            const double x = length * i / 4000;
            const MotionState m{x, std::sqrt(std::max(v * v + 2 * a * x, 0.0)), a, 0};
            const MotionState s = curve.at(x).led_by(m);
            most_v = std::max(most_v, std::abs(s.velocity));
            most_a = std::max(most_a, std::abs(s.acceleration));
            most_j = std::max(most_j, std::abs(s.jerk));
        }
        const TransitionLimits wide{most_v * 1.001, most_a * 1.001, most_a * 1.001, most_j * 1.001};
        INFO("seed " << seed);
        CHECK(check(curve, master, wide) == CurveFault::none);
        TransitionLimits narrow = wide;
        narrow.velocity = most_v * 0.999;
        CHECK(check(curve, master, narrow) == CurveFault::velocity);
        narrow = wide;
        narrow.acceleration = narrow.deceleration = most_a * 0.999;
        CHECK(check(curve, master, narrow) == CurveFault::acceleration);
        narrow = wide;
        narrow.jerk = most_j * 0.999;
        refused += check(curve, master, narrow) == CurveFault::jerk;
    }
    CHECK(refused == 1500);
}

TEST_CASE("a master that turns before the end is looked at as far as it comes") {
    const SyncCurve curve = SyncCurve::between(0, 100, {}, {100, 1, 0, 0});
    const MotionState stops{0, 10, -1, 0};
    CHECK(check(curve, stops, {100, 100, 100, 1e4}) == CurveFault::none);
    CHECK(check(curve, {0, 100, 0, 0}, {100, 1e4, 1e4, 1e6}) == CurveFault::velocity);
    CHECK(check(curve, {0, 0, 0, 0}, {1, 1, 1, 1}) == CurveFault::none);
    CHECK(check(curve, {0, -5, 0, 0}, {1, 1, 1, 1}) == CurveFault::none);
}

TEST_CASE(
    "a curve that its master has not come to is checked with the velocity that it will have") {
    const auto curve = SyncCurve::between(100, 100, {0, 0, 0}, {100, 2, 0});
    const MotionState master{0, 100, 50, 0};
    const MotionState there{100, std::sqrt(100 * 100 + 2 * 50 * 100), 50, 0};
    for (const double velocity : {250, 270, 280, 300, 340, 400}) {
        const TransitionLimits limits{velocity, 1e6, 1e6, 1e9};
        CHECK(check(curve, master, limits) == check(curve, there, limits));
    }
    CHECK(check(curve, master, {340, 1e6, 1e6, 1e9}) == CurveFault::velocity);
}

TEST_CASE("a slave that moves cannot begin a curve over a master that stands") {
    CurvePoint p;
    CHECK_FALSE(start_of_curve({0, 1, 0, 0}, {}, p));
    CHECK(start_of_curve({5, 0, 0, 0}, {}, p));
    CHECK(p.y == 5);
    REQUIRE(start_of_curve({5, 3, 2, 0}, {0, 2, 1, 0}, p));
    const MotionState s = p.led_by({0, 2, 1, 0});
    CHECK(s.velocity == 3);
    CHECK(s.acceleration == 2);
}

TEST_CASE("a modulo slave meets its master at the nearest position, or ahead of it, or behind") {
    const CurvePoint from{10, 0, 0, 0};
    CHECK(sync_position(from, 1, 100, 0, 360, SyncMode::shortest) == 0);
    CHECK(sync_position(from, 1, 100, 0, 360, SyncMode::catch_up) == 360);
    CHECK(sync_position(from, 1, 1000, 0, 360, SyncMode::slow_down) == 360);
    CHECK(sync_position(from, 1, 100, 60, 360, SyncMode::slow_down) == 60);
}

#include "blocks/axis/gear_axis.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr double A = 100, J = 5e4;

/// A slave and its master, which stands in the first scan and has `speed` from there on.
struct Rig {
    GearAxis axis;
    Clock clock;
    double speed = 10;
    double master = 0;

    void scan() {
        if (clock.index > 0) master += speed * seconds(clock.interval);
        scan_at(master, clock.index > 0 ? speed : 0);
    }
    void scan_at(double master_position, double master_velocity) {
        axis.master_position = master_position;
        axis.master_velocity = master_velocity;
        clock.scan(axis);
    }
    void scan_until(std::int64_t time) {
        while (clock.time() <= time) scan();
    }
};

/// As Rig, with the master's position computed, not added up: the same at any interval.
struct ExactRig : Rig {
    void scan() { scan_at(speed * seconds(clock.time()), clock.index > 0 ? speed : 0); }
    void scan_until(std::int64_t time) {
        while (clock.time() <= time) scan();
    }
};

ExactRig coupled(double ratio, std::int64_t interval = millisecond) {
    ExactRig rig;
    rig.clock.interval = interval;
    rig.axis.ratio = ratio;
    rig.scan();
    return rig;
}

/// Checks the limits between scans by differences. Beyond them only rounding is allowed: of the
/// outputs, and of the time within a ramp, which is a difference of times below 4 s.
class Limits {
  public:
    Limits(double acceleration, double jerk) : acceleration_(acceleration), jerk_(jerk) {}

    void see(const GearAxis& axis, std::int64_t interval) {
        const double dt = seconds(interval);
        if (seen_) {
            const double dv = axis.velocity - last_.velocity;
            const double da = axis.acceleration - last_.acceleration;
            const double dx = axis.position - last_.position;
            const double mean = (axis.velocity + last_.velocity) / 2;
            REQUIRE(std::abs(dv) <= acceleration_ * (dt + rounding) + 4 * epsilon * 20);
            const double mean_acceleration = (axis.acceleration + last_.acceleration) / 2;
            REQUIRE(std::abs(dv - mean_acceleration * dt) <=
                    jerk_ * dt * (dt / 4 + rounding) + 4 * epsilon * 200);
            REQUIRE(std::abs(da) <= jerk_ * (dt + rounding) + 4 * epsilon * acceleration_);
            REQUIRE(std::abs(axis.acceleration) <= acceleration_ * (1 + 4 * epsilon));
            REQUIRE(std::abs(dx - mean * dt) <=
                    jerk_ * dt * dt * dt / 4 + 8 * epsilon * (1 + std::abs(axis.position)));
        }
        seen_ = true;
        last_ = axis;
    }

  private:
    static constexpr double rounding = 4 * epsilon * 4;  // [s]

    double acceleration_, jerk_;
    bool seen_ = false;
    GearAxis last_;
};

}  // namespace

TEST_CASE("a ratio change loses dv T / 2 against a slave that changes at once") {
    for (const double dv : {4.0, 0.2, 0.05, -0.05, -0.2, -4.0, -10.0, -14.0}) {
        INFO("dv = " << dv);
        ExactRig rig = coupled(1);
        rig.scan_until(50 * millisecond);
        rig.axis.ratio = 1 + dv / rig.speed;
        rig.scan();
        const double master_at_job = rig.axis.master_position;
        rig.scan_until(500 * millisecond);
        REQUIRE(rig.axis.in_gear);
        const double since = rig.axis.master_position - master_at_job;
        const double at_once = master_at_job + rig.axis.ratio * since;
        const double lost = dv * ramp_duration(dv, A, J) / 2;
        CHECK(std::abs(rig.axis.position - (at_once - lost)) <= 16 * epsilon * 10);
    }
}

TEST_CASE("a transition keeps the limits of acceleration and jerk") {
    for (const double ratio : {1.4, 1.01, 0.99, 0.2, -0.7}) {
        INFO("ratio " << ratio);
        ExactRig rig = coupled(1, 20 * microsecond);
        Limits limits(A, J);
        rig.scan_until(2 * millisecond);
        rig.axis.ratio = ratio;
        while (rig.clock.time() < 250 * millisecond) {
            rig.scan();
            limits.see(rig.axis, rig.clock.interval);
        }
        CHECK(rig.axis.in_gear);
        CHECK(rig.axis.velocity == ratio * rig.speed);
    }
}

TEST_CASE("in_gear is true exactly while the slave is synchronous") {
    ExactRig rig = coupled(1, 20 * microsecond);
    rig.scan_until(2 * millisecond);
    CHECK(rig.axis.in_gear);
    rig.axis.ratio = 1.5;
    const std::int64_t start = rig.clock.time();
    const double T = ramp_duration(0.5 * rig.speed, A, J);
    while (rig.clock.time() < start + 60 * millisecond) {
        const double t = seconds(rig.clock.time() - start);
        rig.scan();
        INFO(t << " s after the change, T = " << T << " s");
        REQUIRE(rig.axis.in_gear == (t >= T - 1e-9));
        REQUIRE(rig.axis.in_gear == (rig.axis.velocity == 1.5 * rig.speed));
    }
}

TEST_CASE("a ratio changed in mid-transition leaves no step in position, velocity, acceleration") {
    for (const std::int64_t after : {1, 3, 20, 39, 41}) {
        for (const double second : {2.0, 1.2, 1.0, 0.5, -1.0}) {
            INFO("second ratio " << second << " after " << after << " ms");
            ExactRig rig = coupled(1, 20 * microsecond);
            rig.scan_until(2 * millisecond);
            rig.axis.ratio = 1.4;
            rig.scan_until(rig.clock.time() + after * millisecond);
            ExactRig unchanged = rig;
            rig.axis.ratio = second;
            rig.scan();
            unchanged.scan();
            CHECK(rig.axis.position == unchanged.axis.position);
            CHECK(rig.axis.velocity == unchanged.axis.velocity);
            CHECK(rig.axis.acceleration == unchanged.axis.acceleration);
            Limits limits(A, J);
            limits.see(rig.axis, rig.clock.interval);
            while (rig.clock.time() < 500 * millisecond) {
                rig.scan();
                limits.see(rig.axis, rig.clock.interval);
            }
            CHECK(rig.axis.in_gear);
            CHECK(rig.axis.velocity == second * rig.speed);
        }
    }
}

TEST_CASE("a master that changes its velocity in mid-transition is followed by a new ramp") {
    Rig rig;
    rig.clock.interval = 20 * microsecond;
    rig.axis.ratio = 1;
    rig.scan_until(2 * millisecond);
    rig.axis.ratio = 1.5;
    Limits limits(A, J);
    while (rig.clock.time() < 22 * millisecond) {
        rig.scan();
        limits.see(rig.axis, rig.clock.interval);
    }
    REQUIRE_FALSE(rig.axis.in_gear);
    rig.speed = 14;
    while (rig.clock.time() < 300 * millisecond) {
        rig.scan();
        limits.see(rig.axis, rig.clock.interval);
    }
    CHECK(rig.axis.in_gear);
    CHECK(rig.axis.velocity == 1.5 * 14);
}

TEST_CASE("a master that ramps is followed rigidly while in gear") {
    Rig rig;
    rig.axis.ratio = 1.5;
    rig.axis.start_position = 3;
    for (int i = 0; i <= 1000; ++i) {
        const double t = i * 1e-3;
        rig.scan_at(20 * t * t, 40 * t);  // 60 mm/s^2 at the slave, then beyond its limit
        REQUIRE(rig.axis.in_gear);
        REQUIRE(rig.axis.position == 3 + 1.5 * (20 * t * t));
        REQUIRE(rig.axis.velocity == 1.5 * (40 * t));
    }
}

TEST_CASE("in gear, the acceleration is the master's times the ratio") {
    Rig rig;
    rig.axis.ratio = -1.5;
    for (int i = 0; i <= 100; ++i) {
        const double t = i * 1e-3;
        rig.axis.master_acceleration = i == 50 ? 0 : 40;
        rig.scan_at(20 * t * t, 40 * t);
        if (i == 0) continue;  // takes up its position
        REQUIRE(rig.axis.in_gear);
        REQUIRE(rig.axis.acceleration == -1.5 * rig.axis.master_acceleration);
        REQUIRE_FALSE(std::signbit(i == 50 ? rig.axis.acceleration : 0));
    }
}

TEST_CASE("a new ratio under an accelerating master leaves no step in the acceleration") {
    for (const double ratio : {1.5, 1.001, 0.5, -1.0}) {
        INFO("ratio " << ratio);
        Rig rig;
        rig.axis.ratio = 1;
        rig.axis.acceleration_limit = 400;
        rig.axis.jerk_limit = 1000;
        Limits limits(400, 1000);
        for (int i = 0; i <= 1500; ++i) {
            const double t = i * 1e-3;
            if (i == 500) rig.axis.ratio = ratio;
            rig.axis.master_acceleration = 100;
            rig.scan_at(50 * t * t, 100 * t);
            if (i > 0) limits.see(rig.axis, rig.clock.interval);
        }
    }
}

TEST_CASE("a slave whose master accelerates gets in gear when the master no longer does") {
    Rig rig;
    rig.clock.interval = 2 * millisecond;
    rig.axis.ratio = 1;
    rig.axis.master_acceleration = 50;
    for (int i = 0; i < 2500; ++i) {
        const double t = i * 2e-3;
        if (i == 250) rig.axis.ratio = 1.1;
        if (i == 2000) rig.axis.master_acceleration = 0;
        const double speed = 50 * std::min(t, 4.0);
        rig.scan_at(speed * t - speed * speed / 100, speed);
        REQUIRE((rig.axis.in_gear || (i >= 250 && i < 2100)));
    }
    CHECK(rig.axis.velocity == 1.1 * 200);
}

TEST_CASE("a constant ratio does not drift in a million scans") {
    Rig rig;
    rig.axis.ratio = 1.0 / 3;
    rig.axis.start_position = 0.1;
    rig.scan_at(0.7, 0);
    double master = 0;
    for (int i = 1; i <= 1'000'000; ++i) {
        master = 0.7 + i * 0.0123;
        rig.scan_at(master, 12.3);
    }
    CHECK(rig.axis.position == 0.1 + 1.0 / 3 * (master - 0.7));
    CHECK(rig.axis.in_gear);
}

TEST_CASE("positions do not depend on the scan interval") {
    const auto positions = [](std::int64_t interval) {
        ExactRig rig = coupled(1, interval);
        std::vector<double> at;
        const double ratios[] = {1.3, 0.4, 0.41, 2};
        for (std::int64_t ms = 1; ms < 400; ++ms) {
            rig.scan_until(ms * millisecond - 1);
            if (ms % 90 == 10) rig.axis.ratio = ratios[ms / 90 % 4];
            rig.scan_until(ms * millisecond);
            at.push_back(rig.axis.position);
        }
        return at;
    };
    const auto coarse = positions(millisecond);
    const auto fine = positions(20 * microsecond);
    REQUIRE(coarse.size() == fine.size());
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        INFO("at " << i + 1 << " ms");
        REQUIRE(std::abs(coarse[i] - fine[i]) <= 1e-12);
    }
}

TEST_CASE("acceleration and jerk are taken with the ratio, not later") {
    ExactRig rig = coupled(1);
    rig.scan_until(10 * millisecond);
    rig.axis.ratio = 1.5;
    rig.axis.acceleration_limit = 50;
    rig.axis.jerk_limit = 2e3;
    const std::int64_t start = rig.clock.time();
    ExactRig other = rig;
    rig.scan();
    other.scan();
    other.axis.acceleration_limit = 500;
    other.axis.jerk_limit = 1e6;
    const double T = ramp_duration(5, 50, 2e3);
    while (rig.clock.time() < start + 300 * millisecond) {
        const double t = seconds(rig.clock.time() - start);
        rig.scan();
        other.scan();
        REQUIRE(rig.axis.position == other.axis.position);
        REQUIRE(rig.axis.in_gear == (t >= T - 1e-9));
    }
    rig.axis.ratio = 1;
    rig.axis.jerk_limit = 5e4;
    const std::int64_t back = rig.clock.time();
    while (!rig.axis.in_gear || rig.axis.ratio * rig.speed != rig.axis.velocity) rig.scan();
    const double T_back = ramp_duration(5, 50, 5e4);
    CHECK(seconds(rig.clock.time() - back - rig.clock.interval) == Approx(T_back).margin(1e-3));
}

TEST_CASE("a slave whose master already moves at the first scan ramps up from standstill") {
    Rig rig;
    rig.axis.ratio = 1;
    rig.axis.acceleration_limit = 50;
    rig.axis.start_position = 7;
    rig.scan_at(0, 10);
    CHECK(rig.axis.position == 7);
    CHECK(rig.axis.velocity == 0);
    CHECK_FALSE(rig.axis.in_gear);
    while (!rig.axis.in_gear) rig.scan();
    const double T = seconds(rig.clock.time() - rig.clock.interval);
    CHECK(T == Approx(ramp_duration(10, 50, J)).margin(1e-3));
    const double exact = ramp_duration(10, 50, J);
    CHECK(rig.axis.position == Approx(7 + 10 * T - 10 * exact / 2).epsilon(1e-12));
}

TEST_CASE("a ratio change at standstill takes no time") {
    Rig rig;
    rig.axis.ratio = 1;
    rig.scan_at(5, 0);
    rig.axis.ratio = 3;
    rig.scan_at(5, 0);
    CHECK(rig.axis.in_gear);
    rig.scan_at(6, 10);
    CHECK(rig.axis.position == 3);
    CHECK(rig.axis.velocity == 30);
}

TEST_CASE("a rising edge of home sets the position") {
    Rig rig;
    rig.axis.home_position = -4;
    rig.axis.home = true;
    rig.scan_at(0, 0);
    CHECK(rig.axis.position == -4);
    rig.axis.home_position = 9;
    rig.scan_at(0, 0);
    CHECK(rig.axis.position == -4);
    rig.axis.home = false;
    rig.scan_at(0, 0);
    rig.axis.home = true;
    rig.scan_at(0, 0);
    CHECK(rig.axis.position == 9);
}

TEST_CASE("homing while in gear sets the position at once and the coupling goes on from it") {
    ExactRig rig = coupled(2);
    rig.scan_until(10 * millisecond);
    rig.axis.home = true;
    rig.axis.home_position = 100;
    rig.scan();
    CHECK(rig.axis.position == 100);
    CHECK(rig.axis.velocity == 20);
    const double master = rig.axis.master_position;
    rig.scan();
    CHECK(rig.axis.position == 100 + 2 * (rig.axis.master_position - master));
}

TEST_CASE("at ratio 0 a rising edge of move positions the axis absolutely") {
    for (const double target : {12.0, -3.0, 0.0}) {
        INFO("target " << target);
        Rig rig;
        rig.clock.interval = 20 * microsecond;
        rig.axis.move_velocity = 5;
        rig.scan();
        rig.axis.target = target;
        rig.axis.move = true;
        Limits limits(A, J);
        rig.scan();
        const bool goes = target != 0;
        if (goes) CHECK(rig.axis.moving);
        rig.axis.target = 99;  // taken with the edge
        double fastest = 0;
        for (int i = 0; i < 200'000 && (rig.axis.moving || i == 0); ++i) {
            rig.scan();
            limits.see(rig.axis, rig.clock.interval);
            fastest = std::max(fastest, std::abs(rig.axis.velocity));
        }
        CHECK_FALSE(rig.axis.moving);
        CHECK(rig.axis.position == target);
        CHECK(rig.axis.velocity == 0);
        CHECK(fastest == Approx(goes ? 5 : 0));
    }
}

TEST_CASE("a ratio given while the axis positions itself couples when it has arrived") {
    Rig rig;
    rig.scan();
    rig.axis.move = true;
    rig.axis.target = 1;
    rig.scan();
    rig.axis.ratio = 1;
    for (int i = 0; i < 50; ++i) {
        rig.scan();
        REQUIRE_FALSE(rig.axis.error);
    }
    while (rig.axis.moving) rig.scan();
    CHECK(rig.axis.position == 1);
    for (int i = 0; i < 200; ++i) rig.scan();
    CHECK(rig.axis.in_gear);
    CHECK(rig.axis.velocity == rig.speed);
}

TEST_CASE("positioning while coupled is refused") {
    ExactRig rig = coupled(1);
    rig.scan_until(10 * millisecond);
    rig.axis.move = true;
    rig.axis.target = 50;
    rig.scan();
    CHECK(rig.axis.error);
    CHECK(rig.axis.error_id == AxisError::not_standing);
    CHECK_FALSE(rig.axis.moving);
    rig.scan();
    CHECK_FALSE(rig.axis.error);
    CHECK(rig.axis.position == rig.axis.master_position);
}

TEST_CASE("a move may come with the ratio 0 that uncouples the standing axis") {
    Rig rig;
    rig.speed = 0;
    rig.axis.ratio = 2;
    rig.scan();
    rig.axis.ratio = 0;
    rig.axis.move = true;
    rig.axis.target = 1;
    rig.scan();
    CHECK_FALSE(rig.axis.error);
    CHECK(rig.axis.moving);
}

TEST_CASE("bad inputs hold the outputs and are named, good ones are followed again") {
    struct Bad {
        double GearAxis::*input;
        double value;
        AxisError error;
    };
    const Bad all[] = {{&GearAxis::master_position, not_a_number, AxisError::not_finite},
                       {&GearAxis::master_velocity, infinite, AxisError::not_finite},
                       {&GearAxis::master_acceleration, infinite, AxisError::not_finite},
                       {&GearAxis::ratio, not_a_number, AxisError::not_finite},
                       {&GearAxis::ratio, -infinite, AxisError::not_finite},
                       {&GearAxis::home_position, not_a_number, AxisError::not_finite},
                       {&GearAxis::target, not_a_number, AxisError::not_finite},
                       {&GearAxis::acceleration_limit, not_a_number, AxisError::not_finite},
                       {&GearAxis::jerk_limit, infinite, AxisError::not_finite},
                       {&GearAxis::acceleration_limit, 0, AxisError::limit_not_positive},
                       {&GearAxis::acceleration_limit, -1, AxisError::limit_not_positive},
                       {&GearAxis::jerk_limit, 0, AxisError::limit_not_positive},
                       {&GearAxis::move_velocity, 0, AxisError::limit_not_positive}};
    for (const Bad& bad : all) {
        INFO("input " << &bad - all);
        ExactRig rig = coupled(1);
        rig.scan_until(10 * millisecond);
        const GearAxis good = rig.axis;
        for (int i = 0; i < 3; ++i) {
            rig.axis.master_position = rig.speed * seconds(rig.clock.time());
            rig.axis.*bad.input = bad.value;
            rig.clock.scan(rig.axis);
            CHECK(rig.axis.error);
            CHECK(rig.axis.error_id == bad.error);
            CHECK(rig.axis.position == good.position);
            CHECK(rig.axis.velocity == good.velocity);
            CHECK(rig.axis.in_gear == good.in_gear);
        }
        rig.axis.*bad.input = good.*bad.input;
        rig.scan();
        CHECK_FALSE(rig.axis.error);
        CHECK(rig.axis.error_id == AxisError::none);
        CHECK(rig.axis.position == rig.axis.master_position);
    }
}

TEST_CASE("a bad input neither repeats an edge nor swallows the first scan") {
    Rig rig;
    rig.axis.start_position = 5;
    rig.axis.home = true;
    rig.axis.home_position = 8;
    rig.axis.ratio = not_a_number;
    rig.scan_at(0, 0);
    CHECK(rig.axis.error);
    rig.axis.ratio = 0;
    rig.axis.home = false;
    rig.scan_at(0, 0);
    CHECK(rig.axis.position == 5);
    rig.axis.home = true;
    rig.scan_at(0, 0);
    CHECK(rig.axis.position == 8);
    rig.axis.ratio = not_a_number;
    rig.axis.home_position = 9;
    rig.scan_at(0, 0);
    rig.axis.ratio = 0;
    rig.scan_at(0, 0);
    CHECK(rig.axis.position == 8);
}

TEST_CASE("a job that cannot be planned is refused, the job before it goes on") {
    ExactRig rig = coupled(1);
    rig.scan_until(10 * millisecond);
    for (const double ratio : {largest, -largest}) {
        rig.axis.ratio = ratio;
        for (int i = 0; i < 5; ++i) {
            rig.scan();
            CHECK(rig.axis.error);
            CHECK(rig.axis.error_id == AxisError::not_finite);
            CHECK(rig.axis.position == rig.axis.master_position);
            CHECK(rig.axis.velocity == rig.speed);
        }
    }
    rig.axis.ratio = 1;
    rig.scan();
    CHECK_FALSE(rig.axis.error);
}

TEST_CASE("a master too far away for a double holds the slave, and comes back") {
    ExactRig rig = coupled(2);
    rig.scan_until(10 * millisecond);
    const double held = rig.axis.position;
    rig.scan_at(largest, rig.speed);
    CHECK(rig.axis.error);
    CHECK(rig.axis.position == held);
    rig.scan();
    CHECK_FALSE(rig.axis.error);
    CHECK(rig.axis.position == 2 * rig.axis.master_position);
}

#include "blocks/profile/velocity_ramp.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "tests/blocks/profile/oracle.hpp"

using namespace lineshaft;
using oracle::Quad;
using oracle::Random;

namespace {

struct Case {
    double v0, a0, v1, A, J;
};

std::string line(const Case& c) {
    char text[200];
    std::snprintf(text, sizeof text, "VelocityRamp{}.plan(%.17g, %.17g, %.17g, %.17g, %.17g)", c.v0,
                  c.a0, c.v1, c.A, c.J);
    return text;
}

VelocityRamp planned(const Case& c) {
    VelocityRamp ramp;
    REQUIRE(ramp.plan(c.v0, c.a0, c.v1, c.A, c.J) == PlanResult::ok);
    return ramp;
}

/// Velocity gained by jerk along the ramp to `peak`, a hold, and back to zero; 0 hold if none.
Quad gained(Quad a, Quad peak, Quad hold, Quad J) {
    const Quad first = peak >= a ? (peak - a) / J : (a - peak) / J;
    return (a + peak) / 2 * first + peak * hold + peak * peak / (2 * J);
}

/// Optimal duration by bisection over the peak acceleration, in quadruple precision.
Quad optimal_duration(const Case& c) {
    Quad a = c.a0;
    Quad dv = Quad(c.v1) - Quad(c.v0);
    const Quad J = c.J;
    const Quad stop = a * (a < 0 ? -a : a) / (2 * J);
    if (dv < stop) {
        a = -a;
        dv = -dv;
    }
    const Quad A = c.A;
    if (a > A || gained(a, A, 0, J) <= dv) {
        const Quad hold = (dv - gained(a, A, 0, J)) / A;
        return (a > A ? a - A : A - a) / J + hold + A / J;
    }
    Quad low = a > 0 ? a : 0;
    Quad high = A;
    for (int i = 0; i < 120; ++i) {
        const Quad middle = (low + high) / 2;
        (gained(a, middle, 0, J) < dv ? low : high) = middle;
    }
    return (low - a) / J + low / J;
}

/// A time of the size sqrt(rounding of the velocities / J): what one ulp of an input may change.
double time_noise(const Case& c) {
    const double gain = c.a0 * c.a0 / (2 * c.J);
    const double size = std::max({std::abs(c.v0), std::abs(c.v1), gain});
    return c.a0 == 0 ? 0 : 4 * std::sqrt(size * std::numeric_limits<double>::epsilon() / c.J);
}

void check(const Case& c) {
    const VelocityRamp r = planned(c);
    const auto require = [&](bool holds, const char* what) {
        if (!holds) oracle::print_failure(what, line(c));
        REQUIRE(holds);
    };
    Quad x = 0, v = c.v0, a = c.a0;
    const double limit = std::max(c.A, std::abs(c.a0));
    const double top = std::max({std::abs(c.v0), std::abs(c.v1), c.a0 * c.a0 / (2 * c.J)});
    for (std::size_t i = 0; i < static_cast<std::size_t>(r.count); ++i) {
        const auto& p = r.phases[i];
        require(p.duration > 0, "phase duration");
        require(std::abs(p.start.jerk) <= c.J, "jerk limit");
        require(std::abs(p.start.acceleration) <= limit, "acceleration limit");
        require(std::abs(double(v) - p.start.velocity) <= 1e-14 * top, "velocity between phases");
        const Quad d = p.duration, j = p.start.jerk;
        x += d * (v + d * (a / 2 + d * j / 6));
        v += d * (a + d * j / 2);
        a += d * j;
    }
    require(r.end.velocity == c.v1, "end velocity");
    require(r.end.acceleration == 0, "end acceleration");
    require(std::abs(double(v) - c.v1) <= 1e-14 * top, "velocity run");
    require(std::abs(double(a)) <= 1e-14 * limit, "acceleration run");
    require(std::abs(double(x) - r.end.position) <= 1e-14 * top * r.duration, "distance");
    const double optimum = double(optimal_duration(c));
    require(std::abs(r.duration - optimum) <= 1e-13 * optimum + time_noise(c), "duration");
}

}  // namespace

TEST_CASE("a ramp from rest has three phases, or two below A^2/J") {
    const VelocityRamp trapezoidal = planned({0, 0, 10, 10, 100});
    CHECK(trapezoidal.count == 3);
    CHECK(trapezoidal.duration == Approx(1.1));
    CHECK(trapezoidal.end.position == Approx(5.5));
    const VelocityRamp triangular = planned({0, 0, 0.25, 10, 100});
    CHECK(triangular.count == 2);
    CHECK(triangular.duration == Approx(0.1));
    CHECK(triangular.end.position == Approx(0.0125));
}

TEST_CASE("a ramp to the velocity it already has takes no time") {
    const VelocityRamp r = planned({3, 0, 3, 10, 100});
    CHECK(r.count == 0);
    CHECK(r.duration == 0);
    CHECK(r.at(-1).velocity == 3);
    CHECK(r.at(2).position == 6);
    CHECK(VelocityRamp{}.at(1).position == 0);
}

TEST_CASE("an acceleration that leads exactly to v1 is only brought to zero") {
    const VelocityRamp r = planned({1, 10, 1.5, 10, 100});
    CHECK(r.count == 1);
    CHECK(r.duration == Approx(0.1));
    CHECK(r.phases[0].start.velocity == 1);
}

TEST_CASE("a ramp that overshoots v1 comes back to it") {
    const VelocityRamp r = planned({1, 10, 1.2, 10, 100});
    CHECK(r.count == 2);
    CHECK(r.phases[0].start.jerk == -100);
    CHECK(r.end.velocity == 1.2);
}

TEST_CASE("an acceleration above the limit comes down to it first") {
    const VelocityRamp r = planned({0, 20, 10, 10, 100});
    CHECK(r.count == 3);
    CHECK(r.phases[0].start.jerk == -100);
    CHECK(r.phases[1].start.acceleration == 10);
    check({0, 20, 10, 10, 100});
    check({0, -20, 10, 10, 100});
    check({0, 20, 1, 10, 100});
}

TEST_CASE("a ramp starts and ends at its exact states and does not jump between phases") {
    const Case c{2, -4, 9, 10, 100};
    const VelocityRamp r = planned(c);
    CHECK(r.at(0).velocity == c.v0);
    CHECK(r.at(0).acceleration == c.a0);
    CHECK(r.at(r.duration).velocity == c.v1);
    CHECK(r.at(r.duration).position == r.end.position);
    CHECK(r.at(r.duration + 2).position == Approx(r.end.position + 2 * c.v1));
    double border = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(r.count); ++i) {
        border += r.phases[i].duration;
        const MotionState before = r.at(border * (1 - 1e-15));
        const MotionState after = r.at(border * (1 + 1e-15));
        CHECK(std::abs(before.position - after.position) < 1e-13);
        CHECK(std::abs(before.velocity - after.velocity) < 1e-12);
        CHECK(std::abs(before.acceleration - after.acceleration) < 1e-11);
    }
}

TEST_CASE("a ramp replanned under way takes no longer than was left") {
    const VelocityRamp whole = planned({0, 0, 10, 10, 100});
    for (int i = 1; i < 1000; ++i) {
        const double t = whole.duration * i / 1000;
        const MotionState now = whole.at(t);
        const VelocityRamp rest = planned({now.velocity, now.acceleration, 10, 10, 100});
        INFO("at " << t);
        CHECK(rest.duration <= (whole.duration - t) + 1e-7);
        CHECK(rest.end.velocity == 10);
    }
}

TEST_CASE("a ramp says what it cannot plan and stays as it was") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    const double huge = std::numeric_limits<double>::max();
    VelocityRamp r = planned({0, 0, 10, 10, 100});
    CHECK(r.plan(0, 0, 1, 0, 1) == PlanResult::limit_not_positive);
    CHECK(r.plan(0, 0, 1, 1, -1) == PlanResult::limit_not_positive);
    CHECK(r.plan(0, 0, 1, nan, 1) == PlanResult::limit_not_positive);
    CHECK(r.plan(0, 0, 1, 1, inf) == PlanResult::limit_not_positive);
    CHECK(r.plan(nan, 0, 1, 1, 1) == PlanResult::not_finite);
    CHECK(r.plan(0, inf, 1, 1, 1) == PlanResult::not_finite);
    CHECK(r.plan(0, 0, -inf, 1, 1) == PlanResult::not_finite);
    CHECK(r.plan(-huge, 0, huge, 1, 1) == PlanResult::not_finite);
    CHECK(r.plan(0, huge, 1, 1, 1) == PlanResult::not_finite);
    CHECK(r.duration == Approx(1.1));
}

TEST_CASE("ramp_duration is the duration of a ramp from zero acceleration") {
    for (const double dv : {0.0, 0.3, 1.0, 10.0, -10.0})
        CHECK(ramp_duration(dv, 10, 100) == Approx(planned({5, 0, 5 + dv, 10, 100}).duration));
}

TEST_CASE("random ramps are optimal, exact and inside their limits") {
    Random random{20230901};
    for (int i = 0; i < 100000; ++i) {
        const double A = random.decades(-3, 4);
        const double J = A * random.decades(-2, 4);
        const double step = A * A / J;
        const double v1 = random.sign() * step * random.decades(-4, 4);
        const double dv = random.sign() * step * random.decades(-4, 4);
        const double kinds[] = {0, A * (2 * random.unit() - 1), 4 * A * (2 * random.unit() - 1), A,
                                -A};
        check({v1 - dv, kinds[random.next() % 5], v1, A, J});
    }
}

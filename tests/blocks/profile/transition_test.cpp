#include "blocks/profile/transition.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/profile/polynomial.hpp"
#include "tests/blocks/profile/oracle.hpp"

using namespace lineshaft;
using oracle::Random;

namespace {

struct Case {
    TransitionLimits limits;
    MotionState slave, guide;
    TransitionGoal goal;
};

std::string line(std::uint64_t seed, const Case& c) {
    return fmt::format(
        "seed {}: V {:.17g} A {:.17g} D {:.17g} J {:.17g}, slave {:.17g} {:.17g} {:.17g}, guide "
        "{:.17g} {:.17g} {:.17g} {:.17g}, mode {}, catch up {}",
        seed, c.limits.velocity, c.limits.acceleration, c.limits.deceleration, c.limits.jerk,
        c.slave.position, c.slave.velocity, c.slave.acceleration, c.guide.position,
        c.guide.velocity, c.guide.acceleration, c.guide.jerk, static_cast<int>(c.goal.mode),
        c.goal.catch_up);
}

/// A slave within its limits, that can stay there, and a guide that it can follow for a while.
Case random_case(std::uint64_t seed) {
    Random random{seed};
    const auto decades = [&](double low, double high) { return random.decades(low, high); };
    Case c;
    c.limits = {decades(0, 3), decades(1, 4), decades(1, 4), decades(2, 6)};
    const double A = std::min(c.limits.acceleration, c.limits.deceleration);
    if (!random.one_in(4)) c.slave.acceleration = random.between(-A, A);
    const double spent = c.slave.acceleration * c.slave.acceleration / (2 * c.limits.jerk);
    const double room = std::max(c.limits.velocity - spent, 0.0);
    if (spent > c.limits.velocity) c.slave.acceleration = 0;
    c.slave.velocity = random.between(-room, room);
    c.slave.position = random.sign() * decades(-3, 4);
    c.guide = {random.sign() * decades(-3, 4), random.between(-0.8, 0.8) * c.limits.velocity};
    if (random.one_in(2)) c.guide.acceleration = random.between(-0.9, 0.9) * A;
    if (random.one_in(4)) c.guide.jerk = random.between(-0.45, 0.45) * c.limits.jerk;
    if (random.one_in(4)) c.goal.mode = TransitionMode::acceleration_limited;
    c.goal.catch_up = random.one_in(2);
    c.goal.offset = c.slave.position - c.guide.position + random.sign() * decades(-3, 2);
    return c;
}

/// The velocities that a slave with the acceleration a0 has gained at most after `time` and with
/// the acceleration `end` then.
double most_gain(double a0, double end, double limit, double J, double time) {
    const double peak = std::min(limit, 0.5 * (J * time + a0 + end));
    const double up = (peak - a0) / J, down = (peak - end) / J;
    return 0.5 * (a0 + peak) * up + peak * (time - up - down) + 0.5 * (peak + end) * down;
}

/// In the slave's own frame, from what it can reach in a time.
double optimum(const Case& c) {
    const auto& [V, A, D, J] = c.limits;
    const double a0 = c.slave.acceleration, end = c.guide.acceleration;
    const auto reaches = [&](double time) {
        if (time < std::abs(a0 - end) / J) return false;
        const double gain = c.guide.velocity + end * time - c.slave.velocity;
        return gain <= most_gain(a0, end, A, J, time) && -gain <= most_gain(-a0, -end, D, J, time);
    };
    double low = 0, high = 1e-6;
    while (!reaches(high)) high *= 2;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (reaches(middle) ? high : low) = middle;
    }
    return high;
}

/// Phase by phase: the slave's acceleration is linear and its velocity quadratic in each.
void check(std::uint64_t seed, const Case& c) {
    Transition t;
    const PlanResult result = plan(c.limits, c.slave, c.guide, c.goal, t);
    const auto require = [&](bool holds, const std::string& what) {
        if (!holds) oracle::print_failure(what, line(seed, c));
        REQUIRE(holds);
    };
    if (result == PlanResult::velocity_above_limit) return require(c.goal.catch_up, "refused");
    require(result == PlanResult::ok, fmt::format("result {}", name(result)));

    const bool jerks = c.goal.mode == TransitionMode::jerk_limited;
    const double more = 1 + 1e-9, J = c.limits.jerk;
    const Range guide_speed =
        range(Polynomial<2>{{t.guide.velocity, t.guide.acceleration, 0.5 * t.guide.jerk}}, 0,
              t.plan.duration);
    for (std::size_t i = 0; i < t.plan.count; ++i) {
        const auto& phase = t.plan.phases[i];
        const MotionState g = t.guide.after(phase.begin);
        MotionState s = phase.start;
        s.velocity += g.velocity;
        s.acceleration += g.acceleration;
        s.jerk += g.jerk;
        require(!jerks || std::abs(s.jerk) <= J * more, "jerk");
        for (const double a : {s.acceleration, s.after(phase.duration).acceleration})
            require(a <= c.limits.acceleration * more && a >= -c.limits.deceleration * more,
                    fmt::format("acceleration {}", a));
        const Polynomial<2> v{{s.velocity, s.acceleration, 0.5 * s.jerk}};
        const double fastest = range(v, 0, phase.duration).size();
        const double allowed = std::max(c.limits.velocity, guide_speed.size());
        require(fastest <= allowed * more, fmt::format("velocity {} in phase {}", fastest, i));
    }
    const MotionState first = t.at(0), last = t.at(t.plan.duration);
    const MotionState guide = t.guide.after(t.plan.duration);
    const double size = 1e-12 * (std::abs(c.slave.position) + std::abs(guide.position) + 1);
    require(std::abs(first.position - c.slave.position) <= size, "position at the start");
    require(std::abs(first.velocity - c.slave.velocity) <= 1e-11 * c.limits.velocity,
            "velocity at the start");
    require(last.velocity == guide.velocity && last.acceleration == guide.acceleration, "end");
    require(!c.goal.catch_up || t.plan.end.position == c.goal.offset, "position caught up");
    if (!c.goal.catch_up && jerks && t.guide.jerk == 0 && c.guide.jerk == 0 &&
        t.guide.acceleration == c.guide.acceleration) {
        const double best = optimum(c), rounding = std::sqrt(c.limits.velocity * 1e-14 / J);
        require(std::abs(t.plan.duration - best) <= 1e-9 * best + 10 * rounding,
                fmt::format("duration {} against {}", t.plan.duration, best));
    }
}

}  // namespace

TEST_CASE("random slaves get in gear with random guides, within their limits, in the least time") {
    const std::uint64_t first = GENERATE(1u, 100000u);
    for (std::uint64_t seed = first; seed < first + 20000; ++seed) check(seed, random_case(seed));
}

TEST_CASE("a transition onto an accelerating guide takes the limits that the guide leaves") {
    Transition t;
    REQUIRE(plan({100, 100, 100, 1e4}, {0, 100, 50, 0}, {0, 110, 55, 0}, {}, t) == PlanResult::ok);
    CHECK(t.plan.phases[0].start.jerk == 1e4);
    CHECK(t.at(t.plan.duration).acceleration == 55);
    CHECK(t.plan.duration == Approx(10.0 / 45).margin(0.02));
}

TEST_CASE("a guide that accelerates more than the slave may is foreseen with its velocity") {
    Transition t;
    REQUIRE(plan({100, 10, 10, 100}, {}, {0, 5, 20, 0}, {}, t) == PlanResult::ok);
    CHECK(t.guide.acceleration == 0);
    CHECK(t.at(t.plan.duration).velocity == 5);
    CHECK_FALSE(t.foresees({0.005 + 1e-5, 5.02, 20, 0}, 1e-3));
}

TEST_CASE("a step takes no time and keeps the position, or catches it up") {
    Transition t;
    const TransitionGoal keeps{TransitionMode::step, false, 7};
    REQUIRE(plan({}, {3, 0, 0, 0}, {1, 50, 9, 0}, keeps, t) == PlanResult::ok);
    CHECK(t.plan.duration == 0);
    CHECK(t.at(0).position == 3);
    CHECK(t.at(0).velocity == 50);
    const TransitionGoal catches{TransitionMode::step, true, 7};
    REQUIRE(plan({}, {3, 0, 0, 0}, {1, 50, 9, 0}, catches, t) == PlanResult::ok);
    CHECK(t.at(0).position == 8);
}

TEST_CASE("a guide that keeps its jerk is foreseen, another one is not") {
    Transition t;
    const MotionState guide{1, 2, 3, 4};
    REQUIRE(plan({100, 100, 100, 1e4}, {}, guide, {}, t) == PlanResult::ok);
    CHECK(t.foresees(guide.after(0.3), 0.3));
    MotionState other = guide.after(0.3);
    other.velocity += 1e-6;
    CHECK_FALSE(t.foresees(other, 0.3));
    other = guide.after(0.3);
    other.jerk = 0;
    CHECK_FALSE(t.foresees(other, 0.3));
}

TEST_CASE("a transition refuses what is no number and what is no limit") {
    Transition t;
    CHECK(plan({}, {}, {NAN, 0, 0, 0}, {}, t) == PlanResult::not_finite);
    CHECK(plan({}, {0, NAN, 0, 0}, {}, {}, t) == PlanResult::not_finite);
    CHECK(plan({1, 0, 1, 1}, {}, {}, {}, t) == PlanResult::limit_not_positive);
    const TransitionGoal catches{TransitionMode::jerk_limited, true, 0};
    CHECK(plan({1, 1, 1, 1}, {}, {0, 2, 0, 0}, catches, t) == PlanResult::velocity_above_limit);
}

#include "blocks/profile/stepped_transition.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/blocks/profile/oracle.hpp"

using namespace lineshaft;
using oracle::Random;

namespace {

struct SteppedCase {
    TransitionLimits limits;
    double quantum = 0;
    MotionState slave, guide;
};

SteppedCase random_steps(std::uint64_t seed) {
    Random random{seed};
    SteppedCase c;
    c.quantum = random.decades(-4, -1);
    c.limits.acceleration = random.decades(0, 3);
    c.limits.deceleration = random.one_in(2) ? c.limits.acceleration : random.decades(0, 3);
    // From a ramp of thirty steps to one that comes at once.
    c.limits.jerk = c.limits.acceleration / c.quantum * random.decades(-1.5, 1);
    const double A = std::min(c.limits.acceleration, c.limits.deceleration);
    if (random.one_in(2)) c.slave.acceleration = random.between(-A, A);
    if (random.one_in(3)) c.guide.acceleration = random.between(-0.5, 0.5) * A;
    c.slave.velocity = random.between(-100, 100);
    c.guide.velocity = c.slave.velocity + random.sign() * A * c.quantum * random.decades(-3, 1.5);
    return c;
}

/// The accelerations of all steps.
std::vector<double> walk(const SteppedCase& c) {
    std::vector<double> steps;
    MotionState slave = c.slave;
    std::int64_t left = 0;
    do {
        const double t = static_cast<double>(steps.size()) * c.quantum;
        const auto next = first_step(c.limits, c.quantum, slave, c.guide.after(t), left);
        REQUIRE(next);
        if (!steps.empty()) REQUIRE(next->left == left - 1);
        left = next->left;
        slave.acceleration = next->acceleration;
        slave = slave.after(c.quantum);
        steps.push_back(next->acceleration);
    } while (left > 0);
    return steps;
}

/// Whether n steps within the limits can end at the guide's velocity, step by step.
bool is_possible(const SteppedCase& c, std::size_t n, double slack) {
    const double h = c.limits.jerk * c.quantum;
    const MotionState end = c.guide.after(static_cast<double>(n) * c.quantum);
    double least = 0, greatest = 0;
    for (std::size_t k = 1; k <= n; ++k) {
        const double up = static_cast<double>(k) * h, down = static_cast<double>(n + 1 - k) * h;
        const double high =
            std::min({c.limits.acceleration, c.slave.acceleration + up, end.acceleration + down});
        const double low =
            std::max({-c.limits.deceleration, c.slave.acceleration - up, end.acceleration - down});
        if (low > high + slack) return false;
        least += low;
        greatest += high;
    }
    const double wanted = (end.velocity - c.slave.velocity) / c.quantum;
    return wanted > least + slack && wanted < greatest - slack;
}

}  // namespace

TEST_CASE("a velocity change in whole steps takes the least number of equal ones") {
    const TransitionLimits limits{1, 100, 100, 5e4};
    struct {
        double dv;
        std::int64_t left;
        double acceleration;
    } const rows[] = {{0.05, 0, 50.0 / 3},   {0.3, 0, 100}, {0.5, 1, 250.0 / 3},
                      {-0.5, 1, -250.0 / 3}, {0.6, 1, 100}, {0, 0, 0}};
    for (const auto& row : rows) {
        CAPTURE(row.dv);
        const auto step = first_step(limits, 0.003, {}, {.velocity = row.dv});
        REQUIRE(step);
        CHECK(step->left == row.left);
        CHECK(step->acceleration == Approx(row.acceleration));
    }
}

TEST_CASE("random steps end at the guide's velocity, within the limits, in the least number") {
    for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
        CAPTURE(seed);
        const SteppedCase c = random_steps(seed);
        const std::vector<double> steps = walk(c);
        const MotionState end = c.guide.after(static_cast<double>(steps.size()) * c.quantum);
        const double slack = 1e-6 * std::max(c.limits.acceleration, c.limits.deceleration);
        const double h = c.limits.jerk * c.quantum;
        double velocity = c.slave.velocity, before = c.slave.acceleration;
        for (const double a : steps) {
            REQUIRE(a <= c.limits.acceleration + slack);
            REQUIRE(a >= -c.limits.deceleration - slack);
            REQUIRE(std::abs(a - before) <= h + slack);
            velocity += a * c.quantum;
            before = a;
        }
        REQUIRE(std::abs(end.acceleration - before) <= h + slack);
        REQUIRE(velocity == Approx(end.velocity).margin(1e-9));
        if (steps.size() > 1)
            REQUIRE_FALSE(is_possible(c, steps.size() - 1, 1e-3 * c.limits.acceleration));
    }
}

TEST_CASE("steps foresee a guide that accelerates more than the slave may with its velocity") {
    const auto step = first_step({1, 100, 100, 1e6}, 0.001, {}, {0, 1, 500, 0});
    REQUIRE(step);
    CHECK(step->left == 9);
    CHECK(step->acceleration == Approx(100));
}

#include "blocks/axis/velocity_loop.hpp"

#include <cmath>

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <unsupported/Eigen/MatrixFunctions>

using namespace lineshaft;

namespace {

using State = VelocityLoop::State;
using Kind = VelocityLoop::Kind;

VelocityLoop first_order(double T) {
    VelocityLoop loop;
    loop.kind = Kind::first_order;
    loop.time_constant = T;
    return loop;
}

VelocityLoop second_order(double w, double zeta) {
    VelocityLoop loop;
    loop.kind = Kind::second_order;
    loop.natural_frequency = w;
    loop.damping = zeta;
    return loop;
}

/// By the exponential of the matrix of x' = v, v' = z - (2 zeta w + d) v - friction,
/// z' = w^2 (u - v), with u and friction as constant states.
State exponential(const VelocityLoop& loop, const State& from, double u, double friction,
                  double t) {
    const double w = loop.natural_frequency;
    Eigen::Matrix<double, 5, 5> A;
    A << 0, 1, 0, 0, 0,                                     //
        0, -2 * loop.damping * w - loop.viscous, 1, 0, -1,  //
        0, -w * w, 0, w * w, 0,                             //
        0, 0, 0, 0, 0, 0, 0, 0, 0, 0;
    Eigen::Matrix<double, 5, 1> x;
    x << from.position, from.velocity, from.integral, u, friction;
    const Eigen::Matrix<double, 5, 5> step = (A * t).exp();
    x = step * x;
    return {x[0], x[1], x[2]};
}

/// By steps too small to matter: sliding friction, and rest where the drive cannot break away.
State brute_force(const VelocityLoop& loop, State s, double u, double t) {
    constexpr int steps = 2'000'000;
    const double h = t / steps, w = loop.natural_frequency;
    for (int i = 0; i < steps; ++i) {
        const bool first = loop.kind == Kind::first_order;
        const double push = first ? (u - s.velocity) / loop.time_constant
                                  : s.integral - 2 * loop.damping * w * s.velocity;
        const double limit = loop.coulomb;
        double force = push - loop.viscous * s.velocity;
        const double before = s.velocity;
        if (before == 0)
            force = std::abs(force) <= limit ? 0 : force - std::copysign(limit, force);
        else
            force -= std::copysign(limit, before);
        s.velocity += h * force;
        if (before * s.velocity < 0) s.velocity = 0;
        s.position += h * s.velocity;
        if (!first) s.integral += h * w * w * (u - s.velocity);
    }
    return s;
}

}  // namespace

TEST_CASE("an ideal velocity loop has the demanded velocity", "[servo]") {
    const State end = VelocityLoop{}.advance({2, 5, 0}, -3, 0.5);
    CHECK(end.position == 0.5);
    CHECK(end.velocity == -3);
}

TEST_CASE("a first-order velocity loop answers a step with 1 - exp(-t / T)", "[servo]") {
    const double T = 0.004, u = 30;
    for (const double t : {1e-6, 0.001, 0.004, 0.1}) {
        const State end = first_order(T).advance({}, u, t);
        CHECK(end.velocity == Approx(u * -std::expm1(-t / T)).epsilon(1e-9));
        CHECK(end.position == Approx(u * (t + T * std::expm1(-t / T))).epsilon(1e-6));
    }
}

TEST_CASE("viscous friction slows the first-order loop to u / (1 + d T)", "[servo]") {
    VelocityLoop loop = first_order(0.01);
    loop.viscous = 50;
    CHECK(loop.advance({}, 30, 10).velocity == Approx(20).epsilon(1e-14));
}

TEST_CASE("Coulomb friction c slows the first-order loop to u - c T", "[servo]") {
    VelocityLoop loop = first_order(0.01);
    loop.coulomb = 500;
    CHECK(loop.advance({}, 30, 10).velocity == Approx(25).epsilon(1e-14));
    CHECK(loop.advance({}, -30, 10).velocity == Approx(-25).epsilon(1e-14));
}

TEST_CASE("a motor sticks up to u / T = c and no further", "[servo]") {
    VelocityLoop loop = first_order(0.01);
    loop.coulomb = 500;
    CHECK(loop.advance({1, 0, 0}, 5, 1).position == 1);
    CHECK(loop.advance({1, 0, 0}, 5.001, 1).position > 1);
}

TEST_CASE("a coasting motor comes to rest after the time and way of constant deceleration",
          "[servo]") {
    VelocityLoop loop = first_order(1e6);
    loop.coulomb = 100;
    const State end = loop.advance({0, 20, 0}, 0, 1);
    CHECK(end.velocity == 0);
    CHECK(end.position == Approx(20.0 * 20 / (2 * 100)).epsilon(1e-6));
}

TEST_CASE("a second-order velocity loop is the matrix exponential of its state space", "[servo]") {
    const State from{1, -20, 300};
    for (const double zeta : {0.0, 0.3, 0.99999999, 1.0, 1.00000001, 1.4, 5.0}) {
        for (const double t : {1e-6, 1e-3, 0.01, 0.1}) {
            INFO("zeta " << zeta << ", t " << t);
            VelocityLoop loop = second_order(200, zeta);
            const State expected = exponential(loop, from, 30, 0, t);
            const State end = loop.advance(from, 30, t);
            CHECK(std::abs(end.position - expected.position) < 1e-11);
            CHECK(std::abs(end.velocity - expected.velocity) < 1e-9);
            CHECK(std::abs(end.integral - expected.integral) < 1e-6);
        }
    }
}

TEST_CASE("friction that keeps its sign is a constant force on the second-order loop", "[servo]") {
    VelocityLoop loop = second_order(150, 0.7);
    loop.viscous = 40;
    loop.coulomb = 900;
    const State from{0, 25, 0};
    const State expected = exponential(loop, from, 30, 900, 0.02);
    const State end = loop.advance(from, 30, 0.02);
    CHECK(std::abs(end.position - expected.position) < 1e-12);
    CHECK(std::abs(end.velocity - expected.velocity) < 1e-9);
}

TEST_CASE("a reversal in mid-interval with friction agrees with tiny steps", "[servo]") {
    VelocityLoop first = first_order(0.01), second = second_order(150, 0.7);
    first.coulomb = second.coulomb = 800;
    first.viscous = second.viscous = 10;
    for (const VelocityLoop& loop : {first, second}) {
        const State from{0, 10, loop.kind == Kind::second_order ? 2900.0 : 0.0};
        const State expected = brute_force(loop, from, -20, 0.05);
        const State end = loop.advance(from, -20, 0.05);
        CHECK(end.velocity < 0);
        CHECK(end.position == Approx(expected.position).margin(2e-6));
        CHECK(end.velocity == Approx(expected.velocity).margin(2e-4));
    }
}

TEST_CASE("one long interval is many short ones", "[servo]") {
    VelocityLoop loop = second_order(150, 0.4);
    loop.coulomb = 800;
    State steps{0, 10, 2900};
    for (int i = 0; i < 500; ++i) steps = loop.advance(steps, -20, 1e-4);
    const State once = loop.advance({0, 10, 2900}, -20, 0.05);
    CHECK(once.position == Approx(steps.position).margin(1e-11));
    CHECK(once.velocity == Approx(steps.velocity).margin(1e-8));
}

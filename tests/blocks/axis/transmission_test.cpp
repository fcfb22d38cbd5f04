#include "blocks/axis/transmission.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "runtime/model/random.hpp"

using namespace lineshaft;

namespace {

/// Deviation of the table from the motor after it has gone through `stops` in small steps, at 10 a
/// second.
double lag(const Transmission& gear, std::initializer_list<double> stops) {
    Transmission::State state;
    double motor = 0;
    for (const double stop : stops) {
        const double from = motor;
        constexpr int steps = 1000;
        for (int i = 1; i <= steps; ++i) {
            motor = from + (stop - from) * i / steps;
            state = gear.advance(state, motor, std::abs(stop - from) / 10 / steps);
        }
    }
    return motor - gear.table(state);
}

double uniform(Random& random, double from, double to) {
    return from + (to - from) * std::ldexp(static_cast<double>(random.next() >> 11), -53);
}

/// Some mechanics; in every fourth the windup goes with the way at the same pace as with the time.
struct Mechanics {
    explicit Mechanics(std::uint64_t seed) : random(seed, "mechanics") {
        gear.windup = uniform(random, 0, 0.1);
        gear.breakaway_windup = uniform(random, 0, 1);
        gear.presliding_travel = std::exp(uniform(random, -9, 4));
        gear.breakaway_time = std::exp(uniform(random, -9, 4));
        way = uniform(random, -20, 20);
        time = std::exp(uniform(random, -9, 4));
        if (seed % 4 == 0) time = std::abs(way) * gear.breakaway_time / gear.presliding_travel;
        if (seed % 4 == 1) way = 0;
        state = {uniform(random, -5, 5), uniform(random, -1, 1), uniform(random, -1, 1)};
    }

    /// `way` and `time` in so many equal parts.
    Transmission::State advanced(int parts) const {
        Transmission::State now = state;
        for (int i = 1; i <= parts; ++i)
            now = gear.advance(now, state.driven + way * i / parts, time / parts);
        return now;
    }

    Random random;
    Transmission gear;
    Transmission::State state;
    double way = 0, time = 0;
};

}  // namespace

TEST_CASE("a transmission is rigid by default", "[servo]") {
    CHECK(lag({}, {10, -5, 3}) == 0);
}

TEST_CASE("backlash: the table stays until the motor has crossed the play", "[servo]") {
    Transmission gear;
    gear.backlash = 0.5;
    CHECK(lag(gear, {10}) == 0.25);
    CHECK(lag(gear, {10, 9.75}) == Approx(0).margin(1e-14));
    CHECK(lag(gear, {10, 9.5}) == Approx(-0.25));
    CHECK(lag(gear, {10, 5}) == -0.25);
    CHECK(lag(gear, {0.2}) == Approx(0.2));
}

TEST_CASE("windup: c in steady motion, -c + 2 c exp(-s / l) after a reversal", "[servo]") {
    Transmission gear;
    gear.windup = 0.04;
    gear.presliding_travel = 0.3;
    CHECK(lag(gear, {20}) == Approx(0.04).epsilon(1e-12));
    for (const double s : {0.1, 0.3, 2.0})
        CHECK(lag(gear, {20, 20 - s}) == Approx(-0.04 + 0.08 * std::exp(-s / 0.3)).epsilon(1e-12));
}

TEST_CASE("breakaway: -(c + k exp(-t / T)) at the time t after a reversal, at any speed",
          "[servo]") {
    Transmission gear;
    gear.windup = 0.01;
    gear.breakaway_windup = 0.22;
    gear.breakaway_time = 1.4;
    for (const double way : {0.2, 10.0, 50.0})
        CHECK(lag(gear, {2000, 2000 - way}) ==
              Approx(-(0.01 + 0.22 * std::exp(-way / 10 / 1.4))).epsilon(1e-10));
    for (const double way : {0.02, 3.0, 500.0}) {
        Transmission::State state = gear.advance({200, 1, 1}, 200 - way, 0.7);
        CHECK(200 - way - gear.table(state) == Approx(-(0.01 + 0.22 * std::exp(-0.5))));
    }
}

TEST_CASE("at standstill the windup of the way stays, what is made up in time goes on", "[servo]") {
    Transmission gear;
    gear.windup = 0.04;
    gear.breakaway_windup = 0.2;
    gear.breakaway_time = 0.5;
    Transmission::State state = gear.advance({}, 20, 0);
    CHECK(20 - gear.table(state) == Approx(0.04 + 0.1));
    state = gear.advance(state, 20, 1);
    CHECK(20 - gear.table(state) == Approx(0.04 + 0.1 * std::exp(-2.0)));
    state = gear.advance(state, 20, 100);
    CHECK(20 - gear.table(state) == Approx(0.04));
}

TEST_CASE("an interval of uniform motion gives the same in any number of parts", "[servo]") {
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
        const Mechanics m(seed);
        const Transmission::State whole = m.advanced(1);
        INFO("seed " << seed << ", way " << m.way << ", time " << m.time);
        for (const int parts : {2, 3, 100}) {
            const Transmission::State end = m.advanced(parts);
            REQUIRE(end.presliding == Approx(whole.presliding).margin(1e-12));
            REQUIRE(end.breakaway == Approx(whole.breakaway).margin(1e-12));
        }
        REQUIRE(std::abs(whole.presliding) <= 1);
        REQUIRE(std::abs(whole.breakaway) <= 1);
    }
}

TEST_CASE("the windup is the solution of its differential equations", "[servo]") {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Mechanics m(seed);
        if (std::abs(m.way) > 30 * m.gear.presliding_travel) m.way = m.gear.presliding_travel;
        m.time = std::min(m.time, 30 * m.gear.breakaway_time);
        constexpr int steps = 100'000;
        const double s = m.way < 0 ? -1 : 1;
        const double a = std::abs(m.way) / m.gear.presliding_travel / steps;
        const double b = m.time / m.gear.breakaway_time / steps;
        double z1 = m.state.presliding, z2 = m.state.breakaway;
        for (int i = 0; i < steps; ++i) {
            const double middle = z1 + a / 2 * (s - z1);
            z2 += b * (middle - z2 - b / 2 * (z1 - z2));
            z1 += a * (s - middle);
        }
        const Transmission::State end = m.advanced(1);
        INFO("seed " << seed);
        CHECK(end.presliding == Approx(z1).margin(1e-6));
        CHECK(end.breakaway == Approx(z2).margin(1e-6));
    }
}

TEST_CASE("the windup does not drift: a million scans back and forth come to the same", "[servo]") {
    Transmission gear;
    gear.windup = 0.015;
    gear.breakaway_windup = 0.25;
    gear.presliding_travel = 0.05;
    gear.breakaway_time = 1.4;
    Transmission::State state;
    const auto go = [&](int cycles) {
        for (int i = 0; i < cycles * 1000; ++i)
            state = gear.advance(state, 20 * std::sin(i % 1000 * 6.283185307179586 / 1000), 0.003);
        return state;
    };
    const Transmission::State early = go(100), late = go(900);
    CHECK(late.presliding == Approx(early.presliding).margin(1e-14));
    CHECK(late.breakaway == Approx(early.breakaway).margin(1e-14));
}

#include "blocks/axis/transmission.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

/// Deviation of the table from the motor after it has gone through `stops` in small steps.
double lag(const Transmission& gear, std::initializer_list<double> stops) {
    Transmission::State state;
    double motor = 0;
    for (const double stop : stops) {
        const double from = motor;
        constexpr int steps = 1000;
        for (int i = 1; i <= steps; ++i) {
            motor = from + (stop - from) * i / steps;
            state = gear.advance(state, motor);
        }
    }
    return motor - gear.table(state);
}

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

TEST_CASE("breakaway: after a reversal -(c + k exp(-s / l2)), whatever the steps", "[servo]") {
    Transmission gear;
    gear.windup = 0.01;
    gear.breakaway_windup = 0.22;
    gear.breakaway_travel = 2;
    for (const double s : {0.02, 1.0, 5.0})
        CHECK(lag(gear, {200, 200 - s}) ==
              Approx(-(0.01 + 0.22 * std::exp(-s / 2))).epsilon(1e-12));
}

TEST_CASE("an axis at rest keeps its windup", "[servo]") {
    Transmission gear;
    gear.windup = 0.04;
    gear.presliding_travel = 0.3;
    const double before = lag(gear, {20, 19.9});
    CHECK(before == lag(gear, {20, 19.9, 19.9}));
}

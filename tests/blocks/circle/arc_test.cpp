#include "blocks/circle/arc.hpp"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

using std::numbers::pi;

/// Two ulps a function call, at most three calls a value.
double rounding(double size) {
    return 8 * epsilon * size;
}

}  // namespace

TEST_CASE("an arc starts at (0, R) and runs clockwise, or the other way round") {
    const Arc there{.radius = 20}, back{.radius = 20, .direction = -1};
    for (const Arc& arc : {there, back}) {
        CHECK(arc.at(0).x == 0);
        CHECK(arc.at(0).y == 20);
        CHECK(arc.at(pi / 2).x == Approx(arc.direction * 20));
        CHECK(std::abs(arc.at(pi).x) <= rounding(20));
        CHECK(arc.at(2 * pi).y == 20);
        CHECK(arc.at(1, 10).y == arc.at(1).y / 2);
    }
}

TEST_CASE("the slope is the derivative of the point") {
    for (const double direction : {1.0, -1.0}) {
        const Arc arc{.radius = 20, .start = 0.3, .direction = direction};
        for (const double theta : {0.0, 1.0, 4.0}) {
            constexpr double h = 1e-5;
            const Point before = arc.at(theta - h), after = arc.at(theta + h);
            const double error = 20 * h * h / 6 + rounding(20) / h;
            CHECK(std::abs(arc.slope(theta).x - (after.x - before.x) / (2 * h)) <= error);
            CHECK(std::abs(arc.slope(theta).y - (after.y - before.y) / (2 * h)) <= error);
        }
    }
}

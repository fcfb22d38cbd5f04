#include "blocks/circle/arc.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr double pi = 3.14159265358979323846;

/// Two ulps a function call, at most three calls a value.
double rounding(double size) {
    return 8 * epsilon * size;
}

}  // namespace

TEST_CASE("a full circle starts and ends at (0, R) and runs clockwise") {
    const Arc arc = Arc::between(20, 0, 2 * pi, 1);
    CHECK(arc.steps == 126);  // round(2 pi 20 / 1)
    CHECK(arc.direction == 1);
    CHECK(arc.at(0).x == 0);
    CHECK(arc.at(0).y == 20);
    CHECK(arc.at(pi / 2).x == Approx(20));
    CHECK(std::abs(arc.at(arc.sweep).x) <= rounding(20));
    CHECK(arc.at(arc.sweep).y == 20);
}

TEST_CASE("an end below the start runs counter-clockwise") {
    const Arc arc = Arc::between(10, pi / 2, 0, 1);
    CHECK(arc.direction == -1);
    CHECK(arc.sweep == pi / 2);
    CHECK(arc.steps == 16);
    CHECK(arc.at(0).x == 10);
    CHECK(arc.at(0.1).y > 0);
    CHECK(arc.at(arc.sweep).y == 10);
}

TEST_CASE("the steps of an arc end exactly at its end") {
    for (const double end : {2 * pi, -2 * pi, 1.0, 0.1, 5.5}) {
        for (const double step : {1.0, 0.5, 0.37, 1e-3}) {
            const Arc arc = Arc::between(20, 0, end, step);
            CHECK(arc.theta(0) == 0);
            CHECK(arc.theta(arc.steps) == arc.sweep);
            CHECK(arc.sweep == std::abs(end));
        }
    }
}

TEST_CASE("chord ratios times the step angle lead from point to point") {
    for (const double end : {2 * pi, -2 * pi, 1.3}) {
        const Arc arc = Arc::between(20, 0.4, end, 1);
        Point p = arc.at(0);
        for (std::int64_t i = 1; i <= arc.steps; ++i) {
            const Point k = arc.chord_ratio(i);
            p.x += k.x * arc.step_angle();
            p.y += k.y * arc.step_angle();
            const Point on_arc = arc.at(arc.theta(i));
            INFO("step " << i);
            const double tolerance = rounding(20) * static_cast<double>(i + 1);
            REQUIRE(std::abs(p.x - on_arc.x) <= tolerance);
            REQUIRE(std::abs(p.y - on_arc.y) <= tolerance);
            REQUIRE(std::abs(std::hypot(on_arc.x, on_arc.y) - 20) <= rounding(20));
        }
    }
}

TEST_CASE("chord ratios are those of equation (7)") {
    const Arc arc = Arc::between(50, 0, 2 * pi, 1);
    const double d = 2 * pi / 314;
    for (const std::int64_t i : {1, 2, 79, 157, 314}) {
        const double n = static_cast<double>(i);
        const double x = 50 * (std::sin(n * d) - std::sin((n - 1) * d)) / d;
        const double y = 50 * (std::cos(n * d) - std::cos((n - 1) * d)) / d;
        CHECK(std::abs(arc.chord_ratio(i).x - x) <= rounding(50) / d);
        CHECK(std::abs(arc.chord_ratio(i).y - y) <= rounding(50) / d);
    }
}

TEST_CASE("the slope is the derivative of the point") {
    for (const double end : {2 * pi, -2 * pi}) {
        const Arc arc = Arc::between(20, 0.3, end, 1);
        for (const double theta : {0.0, 1.0, 4.0}) {
            constexpr double h = 1e-5;
            const Point before = arc.at(theta - h), after = arc.at(theta + h);
            const double error = 20 * h * h / 6 + rounding(20) / h;
            CHECK(std::abs(arc.slope(theta).x - (after.x - before.x) / (2 * h)) <= error);
            CHECK(std::abs(arc.slope(theta).y - (after.y - before.y) / (2 * h)) <= error);
        }
    }
}

TEST_CASE("the sagitta is the height of the arc over the chord") {
    for (const double radius : {20.0, 50.0, 100.0}) {
        const Arc arc = Arc::between(radius, 0, 2 * pi, 1);
        const Point a = arc.at(arc.theta(4)), b = arc.at(arc.theta(5));
        const double middle = std::hypot((a.x + b.x) / 2, (a.y + b.y) / 2);
        CHECK(std::abs(arc.sagitta() - (radius - middle)) <= rounding(radius));
        CHECK(arc.sagitta() == Approx(1.0 / (8 * radius)).epsilon(0.01));
    }
}

TEST_CASE("an arc has at least one step, and no more than can be counted") {
    CHECK(Arc::between(20, 0, 1e-9, 1).steps == 1);
    CHECK(Arc::between(20, 0, 0.01, 1).steps == 1);
    CHECK(Arc::between(20, 0, denormal, 1).steps == 1);
    for (const double step : {denormal, 1e-300, 1e-15}) {
        const Arc arc = Arc::between(20, 0, 2 * pi, step);
        CHECK(arc.steps > 1'000'000);
        CHECK(arc.theta(arc.steps) == arc.sweep);
        CHECK(arc.theta(arc.steps - 1) < arc.sweep);
    }
}

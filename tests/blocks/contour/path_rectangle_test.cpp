#include "blocks/contour/path_rectangle.hpp"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

PathRectangle at(double length) {
    PathRectangle path;
    path.path_velocity = 7;
    path.length = length;
    path.scan({});
    return path;
}

}  // namespace

TEST_CASE("the perimeter, and the middles of the four sides", "[contour]") {
    const double round = at(0).perimeter;
    CHECK(round == Approx(2 * 30 + 2 * 20 + 2 * std::numbers::pi * 5).epsilon(1e-15));
    const double places[4][2] = {{0, -15}, {20, 0}, {0, 15}, {-20, 0}};
    for (int side = 0; side < 4; ++side) {
        const PathRectangle path = at(round * side / 4);
        CHECK(path.x == Approx(places[side][0]).margin(1e-13));
        CHECK(path.y == Approx(places[side][1]).margin(1e-13));
        CHECK(at(round * side / 4 - 3 * round).x == Approx(path.x).margin(1e-12));
    }
}

TEST_CASE("the path goes as far as its length, in the direction of its velocity", "[contour]") {
    const double round = at(0).perimeter;
    constexpr int steps = 20'000;
    PathRectangle last = at(0);
    for (int i = 1; i <= steps; ++i) {
        const PathRectangle path = at(round * i / steps);
        const double dx = path.x - last.x, dy = path.y - last.y, step = round / steps;
        REQUIRE(std::hypot(dx, dy) == Approx(step).epsilon(1e-5));
        REQUIRE(path.velocity_x * dx + path.velocity_y * dy == Approx(7 * step).epsilon(1e-5));
        REQUIRE(std::hypot(path.velocity_x, path.velocity_y) == Approx(7).epsilon(1e-14));
        last = path;
    }
    CHECK(last.y == Approx(-15));
}

TEST_CASE("a rectangle of twice the radius is a circle", "[contour]") {
    PathRectangle path;
    path.width = path.height = 20;
    path.corner_radius = 10;
    for (path.length = 0; path.length < 130; path.length += 0.37) {
        path.scan({});
        CHECK(std::hypot(path.x, path.y) == Approx(10).epsilon(1e-14));
    }
}

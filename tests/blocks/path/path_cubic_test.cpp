#include "blocks/path/path_cubic.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("path_cubic: knots of three points are those found by hand") {
    const std::array<PathVector, 3> points{{{0, 0, 0, 5}, {1, 1, 0, 7}, {2, 0, 0, 9}}};
    const double root = std::sqrt(2);
    const PathKnot begin = knot_of(points, 0), middle = knot_of(points, 1),
                   end = knot_of(points, 2);
    // 4 h y'' = 6 (-1/h * 2) with h = 2^0.5: y'' = -1.5.
    CHECK(middle.second[1] == Approx(-1.5).epsilon(1e-14));
    CHECK(begin.second == PathVector{});
    CHECK(end.second == PathVector{});
    CHECK(begin.first[1] == Approx(1 / root + root / 4).epsilon(1e-14));
    CHECK(middle.first[1] == Approx(0).margin(1e-14));
    CHECK(end.first[1] == Approx(-begin.first[1]).epsilon(1e-14));
    for (const PathKnot& knot : {begin, middle, end}) {
        CHECK(knot.first[0] == Approx(1 / root).epsilon(1e-14));
        CHECK(knot.first[3] == Approx(2 / root).epsilon(1e-14));
    }
    CHECK(middle.position == points[1]);
}

TEST_CASE("path_cubic: points further away than it reaches do not count") {
    std::vector<PathVector> points;
    for (int k = 0; k <= 2 * static_cast<int>(cubic_reach); ++k)
        points.push_back({k + 0.3 * std::sin(7.0 * k), 2 * std::cos(3.0 * k), 0.1 * k});
    const PathKnot whole = knot_of(points, cubic_reach);
    const PathKnot part = knot_of({points.data() + 1, points.size() - 2}, cubic_reach - 1);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(part.first[i] == Approx(whole.first[i]).margin(1e-12));
        CHECK(part.second[i] == Approx(whole.second[i]).margin(1e-12));
    }
}

TEST_CASE("path_cubic: between knots it is the polynomial of degree three") {
    const std::array<PathVector, 4> points{{{0, 0}, {4, 3}, {9, 1}, {12, -4, 2}}};
    for (std::size_t k = 0; k < 3; ++k) {
        const PathKnot a = knot_of(points, k), b = knot_of(points, k + 1);
        std::array<PathCurve, most_spline_parts> parts;
        const std::size_t count = cubic_between(a, b, parts);
        REQUIRE(count > 0);
        CHECK(parts[0].at(0).position == points[k]);
        CHECK(parts[count - 1].end == points[k + 1]);
        for (std::size_t n = 0; n < count; ++n)
            for (std::size_t i = 0; i < most_path_axes; ++i) {
                CHECK(std::abs(parts[n].fourth[i]) <= 1e-12);
                CHECK(std::abs(parts[n].fifth[i]) <= 1e-12);
            }
        const PathPoint end = parts[count - 1].at(parts[count - 1].length);
        const double size = std::hypot(b.first[0], b.first[1], b.first[2]);
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(end.tangent[i] == Approx(b.first[i] / size).margin(1e-12));
    }
}

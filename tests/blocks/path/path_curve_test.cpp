#include "blocks/path/path_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("path_curve: a line is as long as the way and ends exactly") {
    PathCurve line;
    REQUIRE(line_to({1, 2, 3}, {4, 6, 15}, line) == PathFault::none);
    CHECK(line.length == Approx(13).epsilon(1e-15));
    CHECK(line.at(line.length).position == PathVector{4, 6, 15});
    CHECK(line.at(6.5).position[2] == Approx(9).epsilon(1e-15));
    CHECK(line_to({1, 2}, {1, 2}, line) == PathFault::no_length);
    CHECK(line_to({1, NAN}, {1, 2}, line) == PathFault::not_finite);
}

TEST_CASE("path_curve: arcs through a border run through it, the short way or the long one") {
    for (const double border : {0.5, 2.0, 4.0, 5.5}) {
        for (const double last : {1.0, 3.0, std::numbers::pi, 6.0}) {
            if (border >= last) continue;
            const auto on = [](double phi) {
                return PathVector{3 + 2 * std::cos(phi), 1, -2 + 2 * std::sin(phi)};
            };
            PathCurve arc;
            REQUIRE(arc_through(on(0), on(border), on(last), arc) == PathFault::none);
            CHECK(arc.radius == Approx(2).epsilon(1e-12));
            CHECK(arc.length == Approx(2 * last).epsilon(1e-12));
            const PathVector there = arc.at(2 * border).position;
            for (std::size_t i = 0; i < 3; ++i) {
                CHECK(there[i] == Approx(on(border)[i]).margin(1e-12));
            }
            CHECK(arc.at(arc.length).position == on(last));
        }
    }
    PathCurve arc;
    CHECK(arc_through({0, 0}, {1, 1}, {2, 2}, arc) == PathFault::no_arc);
    CHECK(arc_through({1, 2}, {3, 2}, {1, 2}, arc) == PathFault::no_arc);
    CHECK(arc_through({1, 2}, {1, 2}, {3, 2}, arc) == PathFault::no_arc);
    CHECK(arc_through({1, 2}, {3, 2}, {3, 2}, arc) == PathFault::no_arc);
    CHECK(arc_through({1, 2}, {1, 2}, {1, 2}, arc) == PathFault::no_length);
    CHECK(arc_of_radius({1, 2}, {1, 2}, {0, 0, 5}, 0, arc) == PathFault::no_arc);
}

TEST_CASE("path_curve: an arc about a rounded centre meets both ends") {
    PathCurve arc;
    const PathVector up{0, 0, 1}, down{0, 0, -1};
    REQUIRE(arc_about({1, 0}, {1e-7, 0}, {0, 1}, down, 0, arc) == PathFault::none);
    CHECK(arc.length == Approx(1.5 * std::numbers::pi).epsilon(1e-6));
    CHECK(arc.at(0).position[0] == Approx(1).epsilon(1e-15));
    CHECK(arc.at(std::nextafter(arc.length, 0)).position[1] == Approx(1).epsilon(1e-14));
    CHECK(arc_about({1, 0}, {0.1, 0}, {0, 1}, up, 0.01, arc) == PathFault::no_arc);
    CHECK(arc_about({1, 0}, {0, 0}, {0, 1}, {0, 1}, 0.01, arc) == PathFault::no_arc);
}

TEST_CASE("path_curve: arcs of points with five decimals begin and end exactly at them") {
    const auto rounded = [](double x) { return std::round(x * 1e5) / 1e5; };
    for (const double radius : {0.01, 0.3, 7.0, 1234.5})
        for (int k = 0; k < 400; ++k) {
            const double first = 0.1 * k, turn = 0.3 + 5.6 * k / 400;
            CAPTURE(radius, first, turn);
            const PathVector centre{rounded(std::sin(k)), rounded(std::cos(k)), 4};
            const auto on = [&](double angle) {
                return PathVector{rounded(centre[0] + radius * std::cos(angle)),
                                  rounded(centre[1] + radius * std::sin(angle)), 4};
            };
            const PathVector from = on(first), to = on(first + turn);
            PathCurve arc;
            REQUIRE(arc_about(from, centre, to, {0, 0, 1}, 0.01, arc) == PathFault::none);
            CHECK(arc.end == to);
            CHECK(arc.length == Approx(radius * turn).margin(1e-4));
            for (std::size_t i = 0; i < 3; ++i) {
                CHECK(arc.at(0).position[i] == Approx(from[i]).margin(1e-12));
                CHECK(arc.at(std::nextafter(arc.length, 0)).position[i] ==
                      Approx(to[i]).margin(1e-11));
            }
            CHECK(arc_of_radius(from, to, {0, 0, rounded(radius)}, 0.01, arc) == PathFault::none);
            CHECK(arc.end == to);
        }
}

TEST_CASE("path_curve: a centre may be off by a thousandth of the radius or by the rounding") {
    const PathVector up{0, 0, 1};
    PathCurve arc;
    CHECK(arc_about({100, 0}, {}, {0, 100.09}, up, 0.01, arc) == PathFault::none);
    CHECK(arc_about({100, 0}, {}, {0, 100.11}, up, 0.01, arc) == PathFault::no_arc);
    CHECK(arc_about({1, 0}, {}, {0, 1.009}, up, 0.01, arc) == PathFault::none);
    CHECK(arc_about({1, 0}, {}, {0, 1.011}, up, 0.01, arc) == PathFault::no_arc);
    CHECK(arc_about({1e-3, 0}, {}, {0, 1.2e-3}, up, 0.01, arc) == PathFault::no_arc);
    CHECK(arc_of_radius({100, 0}, {-100, 0}, {0, 0, 99.95}, 0.01, arc) == PathFault::none);
    CHECK(arc.radius == 100);
    CHECK(arc_of_radius({100, 0}, {-100, 0}, {0, 0, 99.8}, 0.01, arc) == PathFault::no_arc);
    CHECK(arc_of_radius({10, 0}, {0, 10}, {5e-3, 0, 10}, 0.01, arc) == PathFault::none);
    CHECK(arc_of_radius({10, 0}, {0, 10}, {0.1, 0, 10}, 0.01, arc) == PathFault::no_arc);
}

TEST_CASE("path_curve: an arc about a centre is of any angle up to the whole circle") {
    const PathVector centre{3, -1, 2}, normal{1, 2, -2};
    const PathVector e{2 / std::sqrt(5), -1 / std::sqrt(5), 0};
    const PathVector n{1.0 / 3, 2.0 / 3, -2.0 / 3};
    const PathVector f{n[1] * e[2] - n[2] * e[1], n[2] * e[0] - n[0] * e[2],
                       n[0] * e[1] - n[1] * e[0]};
    const auto on = [&](double phi) {
        PathVector x{};
        for (std::size_t i = 0; i < 3; ++i)
            x[i] = centre[i] + 4 * (e[i] * std::cos(phi) + f[i] * std::sin(phi));
        return x;
    };
    for (const double angle : {0.3, 1.5, 3.1, std::numbers::pi, 3.2, 6.0, 2 * std::numbers::pi}) {
        PathCurve arc;
        const bool closed = angle > 6.1;
        REQUIRE(arc_about(on(0), centre, closed ? on(0) : on(angle), normal, 0, arc) ==
                PathFault::none);
        CHECK(arc.length == Approx(4 * angle).epsilon(1e-12));
        for (std::size_t i = 0; i < 3; ++i) {
            const PathCurve::Extent extent = arc.extent(i);
            double least = 1e9, greatest = -1e9;
            for (int k = 0; k <= 10'000; ++k) {
                const double x = arc.at(arc.length * k / 10'000).position[i];
                least = std::min(least, x), greatest = std::max(greatest, x);
            }
            CHECK(arc.at(2).position[i] == Approx(on(0.5)[i]).margin(angle > 0.5 ? 1e-12 : 10));
            CHECK(extent.least == Approx(least).margin(1e-6));
            CHECK(extent.greatest == Approx(greatest).margin(1e-6));
        }
    }
}

TEST_CASE("path_curve: axes behind the third follow in proportion to the way") {
    PathCurve line, arc;
    REQUIRE(line_to({0, 0, 0, 10}, {3, 4, 0, 20}, line, path_space) == PathFault::none);
    CHECK(line.length == 5);
    CHECK(line.at(2.5).position[3] == 15);
    CHECK(line.share(3) == 2);
    REQUIRE(arc_about({1, 0}, {0, 0}, {-1, 0}, {0, 0, 1}, 0, arc) == PathFault::none);
    let_follow(arc, {1, 0, 0, 0, 10}, {-1, 0, 0, 0, 30});
    CHECK(arc.at(arc.length / 4).position[4] == Approx(15).epsilon(1e-15));
    CHECK(arc.share(4) == Approx(20 / std::numbers::pi).epsilon(1e-15));
    CHECK(arc.end[4] == 30);
}

TEST_CASE("path_curve: a corner passes at its distance and begins and ends without curvature") {
    PathCurve before, after;
    REQUIRE(line_to({0, 0}, {10, 0}, before) == PathFault::none);
    REQUIRE(line_to({10, 0}, {10, 20}, after) == PathFault::none);
    const PathCurve corner = corner_between(before, after, 2);
    CHECK(corner.at(0).position == PathVector{8, 0});
    CHECK(corner.at(corner.length).position == PathVector{10, 2});
    CHECK(corner.at(0).tangent == PathVector{1, 0});
    CHECK(corner.at(corner.length).tangent == PathVector{0, 1});
    CHECK(corner.at(0).bend == PathVector{});
    double nearest = 1e9;
    for (int k = 0; k <= 1000; ++k) {
        const PathVector x = corner.at(corner.length * k / 1000).position;
        nearest = std::min(nearest, std::hypot(x[0] - 10, x[1]));
    }
    CHECK(nearest == Approx(3.0 / 16 * 2 * std::sqrt(2)).epsilon(1e-12));
    CHECK(nearest == Approx(3.0 / 16 * 2 * bend_between(before, after)).epsilon(1e-12));
    const double s = 0.3 * corner.length, h = 1e-4;
    const PathPoint a = corner.at(s - h), b = corner.at(s), c = corner.at(s + h);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(b.tangent[i] == Approx((c.position[i] - a.position[i]) / (2 * h)).margin(1e-7));
        CHECK(b.bend[i] == Approx((c.tangent[i] - a.tangent[i]) / (2 * h)).margin(1e-7));
        CHECK(b.twist[i] == Approx((c.bend[i] - a.bend[i]) / (2 * h)).margin(1e-7));
    }
}

TEST_CASE("path_curve: derivatives are those of the position") {
    PathCurve arc;
    REQUIRE(arc_through({1, 2, 3}, {3, 1, 4}, {5, 2, -1}, arc) == PathFault::none);
    const double s = 0.4 * arc.length, h = 1e-4;
    const PathPoint a = arc.at(s - h), b = arc.at(s), c = arc.at(s + h);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(b.tangent[i] == Approx((c.position[i] - a.position[i]) / (2 * h)).margin(1e-7));
        CHECK(b.bend[i] == Approx((c.tangent[i] - a.tangent[i]) / (2 * h)).margin(1e-7));
        CHECK(b.twist[i] == Approx((c.bend[i] - a.bend[i]) / (2 * h)).margin(1e-7));
    }
}

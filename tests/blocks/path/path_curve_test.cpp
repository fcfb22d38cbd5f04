#include "blocks/path/path_curve.hpp"

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
}

TEST_CASE("path_curve: an arc about a rounded centre meets both ends") {
    PathCurve arc;
    REQUIRE(arc_about({1, 0}, {1e-7, 0}, {0, 1}, true, arc) == PathFault::none);
    CHECK(arc.length == Approx(1.5 * std::numbers::pi).epsilon(1e-6));
    CHECK(arc.at(0).position[0] == Approx(1).epsilon(1e-15));
    CHECK(arc.at(std::nextafter(arc.length, 0)).position[1] == Approx(1).epsilon(1e-14));
    CHECK(arc_about({1, 0}, {0.1, 0}, {0, 1}, true, arc) == PathFault::no_arc);
    CHECK(arc_about({1, 0}, {0, 0}, {-1, 0}, true, arc) == PathFault::no_arc);
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

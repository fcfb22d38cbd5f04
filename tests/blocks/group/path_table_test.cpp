#include "blocks/group/path_table.hpp"

#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("path_table: its outline goes through all points, and lies on the arcs") {
    const auto table = std::make_unique<PathTable>();
    CHECK(table->outline().empty());
    auto& rows = table->table.rows;
    rows[0].position = {10, 0, 0};
    rows[1] = {.position = {0, 10, 0},
               .kind = PathPointKind::arc,
               .border = {10 * std::sqrt(0.5), 10 * std::sqrt(0.5), 0}};
    rows[2].position = {0, 10, 0};  // no length: it is left out
    rows[3].position = {-5, 10, 0};
    rows[4] = {.position = {-8, 6, 0}, .kind = PathPointKind::spline};
    table->table.size = 5;
    const auto line = table->outline();
    REQUIRE(line.size() >= 1 + 64 + 1 + 64);
    CHECK(line.front() == std::array{10.0, 0.0});
    for (std::size_t i = 0; i <= 64; ++i)
        CHECK(std::hypot(line[i][0], line[i][1]) == Approx(10).epsilon(1e-14));
    CHECK(line[64][1] == Approx(10).epsilon(1e-14));
    CHECK(line[65] == std::array{-5.0, 10.0});
    CHECK(line.back()[0] == Approx(-8).epsilon(1e-12));
    CHECK(line.back()[1] == Approx(6).epsilon(1e-12));
}

TEST_CASE("path_table: where a spline turns back it stops, and rotary axes alone move on a line") {
    PathTablePoint there{.position = {10, 0, 0}, .kind = PathPointKind::spline};
    PathTablePoint back{.position = {2, 0, 0}, .kind = PathPointKind::spline};
    PathTablePoint turned{.position = {2, 0, 0}, .kind = PathPointKind::spline, .rotary = {90}};
    PathRowCurves curves;
    std::size_t count = 0;
    REQUIRE(curves_of(there, &back, {}, nullptr, curves, count) == PathFault::none);
    const PathCurve first = curves[count - 1];
    CHECK(first.at(first.length).tangent[0] == 1);
    CHECK(first.at(first.length).bend == PathVector{});
    REQUIRE(curves_of(back, &turned, first.end, &first, curves, count) == PathFault::none);
    CHECK(curves[0].at(0).tangent[0] == -1);
    CHECK(curves[0].at(0).bend == PathVector{});
    const PathCurve second = curves[count - 1];
    REQUIRE(curves_of(turned, &there, second.end, &second, curves, count) == PathFault::none);
    CHECK(count == 1);
    CHECK(curves[0].length == 90);
    const PathCurve third = curves[0];
    REQUIRE(curves_of(there, nullptr, third.end, &third, curves, count) == PathFault::none);
    CHECK(curves[0].at(0).tangent[0] == 1);
}

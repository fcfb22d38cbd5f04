#include "blocks/group/path_table.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

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
    using enum PathPointKind;
    const std::vector<PathTablePoint> rows{{.position = {10, 0, 0}, .kind = spline},
                                           {.position = {2, 0, 0}, .kind = spline},
                                           {.position = {2, 0, 0}, .kind = spline, .rotary = {90}},
                                           {.position = {10, 0, 0}, .kind = spline}};
    const PathRows table{rows, {}};
    PathRowCurves curves;
    std::size_t count = 0;
    REQUIRE(curves_of(table, 0, {}, nullptr, curves, count) == PathFault::none);
    const PathCurve first = curves[count - 1];
    CHECK(first.at(first.length).tangent[0] == 1);
    CHECK(first.at(first.length).bend == PathVector{});
    REQUIRE(curves_of(table, 1, first.end, &first, curves, count) == PathFault::none);
    CHECK(curves[0].at(0).tangent[0] == -1);
    CHECK(curves[0].at(0).bend == PathVector{});
    const PathCurve second = curves[count - 1];
    REQUIRE(curves_of(table, 2, second.end, &second, curves, count) == PathFault::none);
    CHECK(count == 1);
    CHECK(curves[0].length == 90);
    const PathCurve third = curves[0];
    REQUIRE(curves_of(table, 3, third.end, &third, curves, count) == PathFault::none);
    CHECK(curves[0].at(0).tangent[0] == 1);
}

namespace {

/// The greatest jumps of tangent and curvature where curves of a table meet, from one row on.
struct Jumps {
    double tangent = 0, bend = 0;
};

Jumps jumps_of(const PathRows& table, std::size_t first, std::size_t last) {
    Jumps out;
    PathRowCurves curves;
    PathCurve before;
    for (std::size_t k = 0, count = 0; k <= last; ++k) {
        REQUIRE(curves_of(table, k, table.knot(k), k > 0 ? &before : nullptr, curves, count) ==
                PathFault::none);
        CHECK(curves[count - 1].end == table.rows[k].target());
        for (std::size_t n = 0; n < count; ++n) {
            const PathPoint a = before.at(before.length), b = curves[n].at(0);
            for (std::size_t i = 0; i < most_path_axes && (n > 0 || k >= first); ++i) {
                out.tangent = std::max(out.tangent, std::abs(a.tangent[i] - b.tangent[i]));
                out.bend = std::max(out.bend, std::abs(a.bend[i] - b.bend[i]));
            }
            before = curves[n];
        }
    }
    return out;
}

}  // namespace

TEST_CASE("path_table: cubic rows are one spline whose tangent and curvature go on") {
    std::vector<PathTablePoint> rows;
    for (int k = 1; k <= 100; ++k)
        rows.push_back({.position = {3.0 * k + std::sin(5.0 * k), 4 * std::cos(2.0 * k), 0.2 * k},
                        .kind = PathPointKind::cubic,
                        .rotary = {10 * std::sin(1.0 * k)}});
    const PathRows table{rows, {}};
    const Jumps jumps = jumps_of(table, 1, rows.size() - 1);
    CHECK(jumps.tangent <= 1e-12);
    CHECK(jumps.bend <= 1e-10);
    PathRowCurves curves;
    std::size_t count = 0;
    REQUIRE(curves_of(table, 0, {}, nullptr, curves, count) == PathFault::none);
    CHECK(std::abs(curves[0].at(0).bend[1]) <= 1e-13);
    REQUIRE(curves_of(table, 99, table.knot(99), nullptr, curves, count) == PathFault::none);
    CHECK(std::abs(curves[count - 1].at(curves[count - 1].length).bend[1]) <= 1e-13);
}

TEST_CASE("path_table: a spline of degree five leads into a cubic one and out of it evenly") {
    const auto row = [](double x, double y, PathPointKind kind) {
        return PathTablePoint{.position = {x, y, 0}, .kind = kind};
    };
    using enum PathPointKind;
    const std::vector<PathTablePoint> rows{
        row(10, 0, line),   row(20, 5, spline),  row(25, 15, cubic), row(35, 12, cubic),
        row(40, 20, cubic), row(50, 20, spline), row(60, 20, line)};
    const Jumps jumps = jumps_of({rows, {}}, 1, rows.size() - 1);
    CHECK(jumps.tangent <= 1e-12);
    CHECK(jumps.bend <= 1e-10);
}

TEST_CASE("path_table: where cubic rows turn back, or a point is there twice, two splines meet") {
    using enum PathPointKind;
    const std::vector<PathTablePoint> rows{{.position = {10, 0, 0}, .kind = cubic},
                                           {.position = {2, 0, 0}, .kind = cubic},
                                           {.position = {5, 8, 0}, .kind = cubic},
                                           {.position = {5, 8, 0}, .kind = cubic},
                                           {.position = {9, 8, 0}, .kind = cubic}};
    const PathRows table{rows, {}};
    PathRowCurves curves;
    std::size_t count = 0;
    REQUIRE(curves_of(table, 0, {}, nullptr, curves, count) == PathFault::none);
    CHECK(curves[count - 1].at(curves[count - 1].length).tangent[0] == Approx(1));
    CHECK(curves_of(table, 3, rows[2].target(), nullptr, curves, count) == PathFault::no_length);
    REQUIRE(curves_of(table, 4, rows[3].target(), nullptr, curves, count) == PathFault::none);
    CHECK(count == 1);
    CHECK(curves[0].at(0).tangent[0] == Approx(1));
}

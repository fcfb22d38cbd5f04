#include "blocks/contour/baseline.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/contour/contour_comparison.hpp"
#include "runtime/model/random.hpp"

using namespace lineshaft;

namespace {

double uniform(Random& random) {
    return static_cast<double>(random.next() >> 11) * 0x1p-53;
}

std::vector<Point> wandering(std::size_t count, Random& random) {
    std::vector<Point> points;
    double x = 0, y = 0, angle = 0;
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back({x, y});
        angle += uniform(random) - 0.5;
        const double step = 0.5 + uniform(random);
        x += step * std::cos(angle);
        y += step * std::sin(angle);
    }
    return points;
}

std::vector<SplineSpan> spline_of(const std::vector<Point>& points) {
    std::vector<SplineSpan> spans(points.size() - 1);
    natural_spline(points, spans);
    return spans;
}

double distance(Point a, Point b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

}  // namespace

TEST_CASE("polyline distance: foot on a segment, else the nearer end", "[contour]") {
    const std::vector<Point> points{{0, 0}, {2, 0}, {2, 2}};
    CHECK(polyline_distance(points, 1, {1.5, 0.25}) == 0.25);
    CHECK(polyline_distance(points, 1, {2.5, 1}) == 0.5);
    CHECK(polyline_distance(points, 0, {-3, 4}) == 5);
    CHECK(polyline_distance(points, 1, {2.3, -0.4}) == Approx(0.5));
}

TEST_CASE("a natural spline passes its points, is smooth to s'' and ends straight", "[contour]") {
    Random random(3, "spline");
    const auto points = wandering(60, random);
    const auto spans = spline_of(points);
    const auto h = [&](std::size_t i) { return distance(points[i], points[i + 1]); };
    const auto second = [&](std::size_t i, double t) {
        return (2 * spans[i].c[2].x + 6 * spans[i].c[3].x * t) / (h(i) * h(i));
    };
    for (std::size_t i = 0; i < spans.size(); ++i) {
        CHECK(distance(spans[i].at(0), points[i]) == 0);
        CHECK(distance(spans[i].at(1), points[i + 1]) < 1e-13);
        if (i + 1 == spans.size()) break;
        const auto& c = spans[i].c;
        CHECK((c[1].x + 2 * c[2].x + 3 * c[3].x) / h(i) ==
              Approx(spans[i + 1].c[1].x / h(i + 1)).margin(1e-12));
        CHECK(second(i, 1) == Approx(second(i + 1, 0)).margin(1e-12));
    }
    CHECK(second(0, 0) == 0);
    CHECK(std::abs(second(spans.size() - 1, 1)) < 1e-13);
}

TEST_CASE("spline distance is the least over a dense sampling of the spans", "[contour]") {
    Random random(4, "spline");
    for (int trial = 0; trial < 200; ++trial) {
        const auto points = wandering(8, random);
        const auto spans = spline_of(points);
        const Point p{points[4].x + uniform(random) - 0.5, points[4].y + uniform(random) - 0.5};
        double dense = 1e9;
        for (const std::size_t i : {std::size_t{3}, std::size_t{4}})
            for (int k = 0; k <= 5000; ++k)
                dense = std::min(dense, distance(spans[i].at(k / 5000.0), p));
        const double found = spline_distance(spans, 4, p);
        CHECK(found <= dense + 1e-14);
        CHECK(dense - found <= 2e-4);
        CHECK(dense * dense - found * found <= 1e-7);
    }
}

TEST_CASE("spline distance to points on a line and near it", "[contour]") {
    std::vector<Point> points;
    for (int i = 0; i < 20; ++i) points.push_back({0.1 * i, 0.2 * i});
    const auto spans = spline_of(points);
    const Point normal{-2 / std::sqrt(5.0), 1 / std::sqrt(5.0)};
    for (const double e : {0.0, 1e-9, 0.05}) {
        const Point p{1.03 + e * normal.x, 2.06 + e * normal.y};
        CHECK(std::abs(spline_distance(spans, 10, p) - e) < 2e-15);
    }
}

TEST_CASE("a spline through a circle is less than a nanometre off it", "[contour]") {
    const double R = 20, step = 0.025;
    std::vector<Point> points;
    for (int i = 0; i < 400; ++i)
        points.push_back({R * std::cos(i * step / R), R * std::sin(i * step / R)});
    const auto spans = spline_of(points);
    for (const double s : {0.0, 0.3, 0.5}) {
        const double angle = (200 + s) * step / R;
        const Point p{(R + 0.01) * std::cos(angle), (R + 0.01) * std::sin(angle)};
        CHECK(std::abs(spline_distance(spans, 200, p) - 0.01) < 1e-11);
    }
}

TEST_CASE("the comparison's window agrees with the spline through all points", "[contour]") {
    Random random(5, "window");
    const auto points = wandering(300, random);
    const auto spans = spline_of(points);
    ContourComparison block;
    block.enable = true;
    int compared = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t behind = i < 14 ? 0 : i - 14;
        const Point p{points[behind].x + 0.1, points[behind].y - 0.05};
        block.command_x = points[i].x;
        block.command_y = points[i].y;
        block.actual_x = p.x;
        block.actual_y = p.y;
        block.scan({});
        const auto back = static_cast<std::size_t>(block.path.nearest(p));
        if (back < 12) continue;
        ++compared;
        CHECK(std::abs(block.spline - spline_distance(spans, i - back, p)) < 1e-7);
    }
    CHECK(block.samples == 300);
    CHECK(compared > 200);
}

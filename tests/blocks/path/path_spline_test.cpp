#include "blocks/path/path_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/path/path.hpp"
#include "blocks/path/path_bound.hpp"

using namespace lineshaft;

namespace {

using Parts = std::array<PathCurve, most_spline_parts>;

/// A spline through points, its ends along the first and the last chord.
std::vector<PathCurve> through(const std::vector<PathVector>& points) {
    std::vector<PathCurve> out;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const PathPoint from = waypoint(points[i == 0 ? 0 : i - 1], points[i], points[i + 1]);
        const PathPoint to =
            waypoint(points[i], points[i + 1], points[std::min(i + 2, points.size() - 1)]);
        Parts parts;
        const std::size_t count = spline_between(from, to, parts);
        REQUIRE(count > 0);
        out.insert(out.end(), parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return out;
}

const std::vector<PathVector> wave = {{0, 0, 0, 10},  {10, 8, 1, 20},  {22, 3, 2, 10},
                                      {30, -9, 0, 0}, {44, -4, 1, 50}, {50, 7, 3, 60}};

double size_in_space(const PathVector& x) {
    return std::hypot(x[0], x[1], x[2]);
}

PathLimits limits_of_all(const PathLimit& axis) {
    PathLimits limits{axis, {}};
    limits.axes.fill(axis);
    return limits;
}

}  // namespace

TEST_CASE("path_spline: it passes its points with tangent and curvature, and evenly") {
    const std::vector<PathCurve> curves = through(wave);
    CHECK(curves.front().at(0).position == wave.front());
    CHECK(curves.back().at(curves.back().length).position == wave.back());
    for (std::size_t i = 0; i + 1 < curves.size(); ++i) {
        const PathPoint a = curves[i].at(curves[i].length), b = curves[i + 1].at(0);
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(a.position[k] == Approx(b.position[k]).margin(1e-12));
            CHECK(a.tangent[k] == Approx(b.tangent[k]).margin(1e-12));
            CHECK(a.bend[k] == Approx(b.bend[k]).margin(1e-11));
        }
    }
    for (const PathCurve& c : curves)
        for (int k = 0; k <= 1000; ++k)
            CHECK(std::abs(size_in_space(c.at(c.length * k / 1000).tangent) - 1) <= 2e-4);
}

TEST_CASE("path_spline: derivatives are those of the position, and bounds hold between samples") {
    for (const PathCurve& c : through(wave)) {
        const double h = c.length * 1e-4;
        std::array<PathBound, 4> most;
        for (int k = 1; k < 1000; ++k) {
            const double s = c.length * k / 1000;
            const PathPoint a = c.at(s - h), x = c.at(s), b = c.at(s + h);
            for (std::size_t i = 0; i < 4; ++i) {
                CHECK((b.position[i] - a.position[i]) / (2 * h) ==
                      Approx(x.tangent[i]).margin(1e-5));
                CHECK((b.tangent[i] - a.tangent[i]) / (2 * h) == Approx(x.bend[i]).margin(1e-5));
                CHECK((b.bend[i] - a.bend[i]) / (2 * h) == Approx(x.twist[i]).margin(1e-5));
                most[i].tangent = std::max(most[i].tangent, std::abs(x.tangent[i]));
                most[i].bend = std::max(most[i].bend, std::abs(x.bend[i]));
                most[i].twist = std::max(most[i].twist, std::abs(x.twist[i]));
                const PathCurve::Extent extent = c.extent(i);
                CHECK(x.position[i] >= extent.least - 1e-9);
                CHECK(x.position[i] <= extent.greatest + 1e-9);
            }
        }
        for (std::size_t i = 0; i < 4; ++i) {
            const PathBound bound = bound_of(c, i);
            CHECK(bound.tangent >= most[i].tangent);
            CHECK(bound.bend >= most[i].bend);
            CHECK(bound.twist >= most[i].twist);
            CHECK(bound.tangent <= 1.2 * most[i].tangent + 0.1);
        }
    }
}

TEST_CASE("path_spline: points on a circle are passed along it") {
    std::vector<PathVector> points;
    for (int k = 0; k <= 6; ++k) {
        const double turn = k * std::numbers::pi / 3;
        points.push_back({10 * std::cos(turn), 10 * std::sin(turn), 0, 60.0 * k});
    }
    for (std::size_t i = 1; i + 2 < points.size(); ++i) {
        const PathPoint from = waypoint(points[i - 1], points[i], points[i + 1]);
        const PathPoint to = waypoint(points[i], points[i + 1], points[i + 2]);
        CHECK(size_in_space(from.bend) == Approx(0.1).epsilon(1e-12));
        CHECK(from.tangent[3] == Approx(18 / std::numbers::pi).epsilon(1e-12));
        Parts parts;
        const std::size_t count = spline_between(from, to, parts);
        REQUIRE(count > 0);
        for (std::size_t k = 0; k < count; ++k)
            for (int n = 0; n <= 8; ++n)
                CHECK(size_in_space(parts[k].at(parts[k].length * n / 8).position) ==
                      Approx(10).epsilon(1e-4));
    }
}

TEST_CASE("path_spline: the sharpest turns are passed") {
    for (int turn = 0; turn < 180; ++turn)
        for (const double length : {1.0, 10.0, 200.0}) {
            CAPTURE(turn, length);
            const double angle = turn * std::numbers::pi / 180;
            for (const PathCurve& c : through(
                     {{0, 0}, {10, 0}, {10 + length * std::cos(angle), length * std::sin(angle)}}))
                for (int k = 0; k <= 100; ++k)
                    CHECK(std::abs(size_in_space(c.at(c.length * k / 100).tangent) - 1) <= 2e-2);
        }
}

TEST_CASE("path_spline: behind an arc that is small beside the chord it stays near its points") {
    for (const double radius : {0.01, 0.1, 0.5, 2.0, 10.0}) {
        PathPoint from;
        from.tangent = {0, -1};
        from.bend = {-1 / radius};
        const PathPoint to = waypoint({0, 0}, {20, -5}, {40, 0});
        Parts parts;
        const std::size_t count = spline_between(from, to, parts);
        REQUIRE(count > 0);
        CHECK(parts[0].at(0).bend[0] == Approx(-1 / radius));
        double length = 0;
        for (std::size_t i = 0; i < count; ++i) {
            length += parts[i].length;
            for (double share = 0; share <= 1; share += 0.125) {
                const PathVector x = parts[i].at(share * parts[i].length).position;
                CHECK(x[0] >= -5);
                CHECK(x[0] <= 20 + 1e-9);
                CHECK(std::abs(x[1]) <= 15);
            }
        }
        CHECK(length < 40);
    }
}

TEST_CASE("path_spline: between tangents at a right angle, over 50 mm") {
    PathPoint from, to;
    from.tangent = {0, 1};
    to.position = {50};
    to.tangent = {1, 0};
    Parts parts;
    const std::size_t count = spline_between(from, to, parts);
    REQUIRE(count > 0);
    for (std::size_t k = 0; k < count; ++k)
        for (int n = 0; n <= 100; ++n)
            CHECK(std::abs(size_in_space(parts[k].at(parts[k].length * n / 100).tangent) - 1) <=
                  2e-4);
    CHECK(parts[count - 1].end == to.position);
}

TEST_CASE("path_spline: it is run along within limits, evenly where they allow") {
    PathLimits limits = limits_of_all({20, 1000, 1e5});
    limits.path.velocity = 10;
    limits.axes[3] = {1e3, 1e5, 1e7};
    std::vector<PathPiece> ring(64);
    Path path;
    for (const PathCurve& c : through(wave))
        REQUIRE(path.append(ring, c, limits) == PathFault::none);
    double least = 10, most = 0, time = 0;
    for (; !path.finished(); time += 1e-3) {
        const PathMotion m = path.advance(ring, 1e-3);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(std::abs(m.velocity[i]) <= limits.axes[i].velocity * (1 + 1e-9));
            CHECK(std::abs(m.acceleration[i]) <= limits.axes[i].acceleration * (1 + 1e-9));
            CHECK(std::abs(m.jerk[i]) <= limits.axes[i].jerk * (1 + 1e-9));
        }
        const double place = m.path.position;
        if (place < 28 || place > 38) continue;
        least = std::min(least, size_in_space(m.velocity));
        most = std::max(most, size_in_space(m.velocity));
    }
    CHECK(most / least - 1 <= 5e-4);
    CHECK(path.now(ring).position == wave.back());
}

TEST_CASE("path_spline: a line runs into an arc through a transition within the deviation") {
    PathCurve line, arc;
    REQUIRE(line_to({-30, 0}, {0, 0}, line) == PathFault::none);
    REQUIRE(arc_through({0, 0}, {20, 20}, {0, 40}, arc) == PathFault::none);
    constexpr double deviation = 0.01;
    const double far = distance_within(deviation, line, arc, line.length);
    CHECK(far > 0.5);
    const PathLimits limits = limits_of_all({100, 2000, 5e4});
    std::vector<PathPiece> ring(16);
    Path path;
    REQUIRE(path.append(ring, line, limits) == PathFault::none);
    REQUIRE(path.append(ring, arc, limits, {0, far}) == PathFault::none);
    CHECK(path.count > 2);
    double slowest = 100, most = 0;
    while (!path.finished()) {
        const PathMotion m = path.advance(ring, 1e-4);
        const auto& x = m.position;
        const double off = x[0] < 0 ? std::abs(x[1]) : std::abs(std::hypot(x[0], x[1] - 20) - 20);
        most = std::max(most, off);
        if (std::abs(m.path.position - 30) < 10) slowest = std::min(slowest, m.path.velocity);
        for (std::size_t i = 0; i < 2; ++i) {
            CHECK(std::abs(m.acceleration[i]) <= 2000 * (1 + 1e-9));
            CHECK(std::abs(m.jerk[i]) <= 5e4 * (1 + 1e-9));
        }
    }
    CHECK(most <= deviation);
    CHECK(most >= 0.5 * deviation);
    CHECK(slowest > 20);
    CHECK(path.now(ring).position == arc.end);
}

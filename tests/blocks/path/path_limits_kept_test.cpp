#include "blocks/path/path_limits_kept.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/path/path.hpp"
#include "blocks/path/path_spline.hpp"

using namespace lineshaft;

namespace {

using Numbers = std::mt19937_64;

double within(Numbers& numbers, double least, double most) {
    return least + (most - least) * (static_cast<double>(numbers() >> 11) * 0x1p-53);
}

PathCurve random_curve(Numbers& numbers) {
    const auto point = [&] {
        PathVector x{};
        for (std::size_t i = 0; i < 3; ++i) x[i] = within(numbers, -10, 10);
        return x;
    };
    PathCurve a, b;
    const double kind = within(numbers, 0, 3);
    if (kind < 1) {
        while (arc_through(point(), point(), point(), a) != PathFault::none) continue;
        return a;
    }
    const PathVector vertex = point();
    while (line_to(point(), vertex, a) != PathFault::none) continue;
    while (line_to(vertex, point(), b) != PathFault::none) continue;
    const double far = 0.5 * std::min(a.length, b.length);
    if (kind < 2) return corner_between(a, b, far);
    std::array<PathCurve, most_spline_parts> parts;
    if (spline_between(a.at(a.length - far), b.at(far), parts) == 0) return a;
    return parts[0];
}

/// The greatest quotient at many instants.
double sampled(const PathPiece& piece, const PathCourse& course) {
    constexpr int instants = 400;
    double most = 0;
    for (int n = 0; n <= instants; ++n) {
        const MotionState s = course.at(course.duration * n / instants * (1 - 1e-12));
        const PathPoint x = piece.curve.at(s.position);
        const double v = s.velocity, a = s.acceleration, j = s.jerk;
        for (std::size_t i = 0; i < 3; ++i) {
            const PathLimit& limit = piece.limits.axes[i];
            most = std::max(
                {most, std::abs(x.tangent[i] * v) / limit.velocity,
                 std::abs(x.tangent[i] * a + x.bend[i] * v * v) / limit.acceleration,
                 std::abs(x.tangent[i] * j + 3 * x.bend[i] * v * a + x.twist[i] * v * v * v) /
                     limit.jerk});
        }
        most = std::max({most, v / piece.limits.path.velocity,
                         std::abs(a) / piece.limits.path.acceleration,
                         std::abs(j) / piece.limits.path.jerk});
    }
    return most;
}

}  // namespace

TEST_CASE(
    "path_limits_kept: what is allowed keeps its limits at every instant, all that is well "
    "below them is allowed") {
    Numbers numbers(7);
    int allowed = 0, refused = 0;
    for (int problem = 0; problem < 3000; ++problem) {
        INFO("problem " << problem);
        std::vector<PathPiece> ring(2);
        Path path;
        const PathCurve curve = random_curve(numbers);
        PathLimits limits{{within(numbers, 10, 40), within(numbers, 100, 400), 0}, {}};
        limits.path.jerk = std::pow(10, within(numbers, 3, 4.5));
        for (PathLimit& axis : limits.axes)
            axis = {within(numbers, 10, 40), within(numbers, 100, 400),
                    std::pow(10, within(numbers, 3, 4.5))};
        if (path.append(ring, curve, limits) != PathFault::none) continue;
        const double v = std::pow(10, within(numbers, -1, 1.6));
        const double lasts = within(numbers, 0.02, 0.3) * curve.length / v;
        const bool has_slope = within(numbers, 0, 1) < 0.5;
        const double a = within(numbers, -0.3, 1) * v / lasts;
        const double bend = within(numbers, -1, 1);
        const PathPhase phase{
            0,
            {0.3 * curve.length, v, a, has_slope ? 0 : bend * v / (lasts * lasts)},
            has_slope ? bend / (lasts * lasts) : 0};
        PathCourse course;
        REQUIRE(course.add(phase, lasts));
        std::array<double, 1> quotients{};
        const bool keeps = keeps_limits({ring, 0, 1}, course, 0, quotients);
        const double most = sampled(ring[0], course);
        if (keeps) CHECK(most <= 1 + 1e-10);
        if (most < 0.9 && curve.kind == PathCurveKind::arc) CHECK(keeps);
        CHECK(keeps == (quotients[0] <= 1 + 1e-11));
        ++(keeps ? allowed : refused);
    }
    CHECK(allowed > 300);
    CHECK(refused > 300);
}

TEST_CASE("path_limits_kept: an arc is run along with all of the speed that its axes allow") {
    std::vector<PathPiece> ring(2);
    Path path;
    PathCurve arc;
    REQUIRE(arc_through({20, 0}, {0, 20}, {-20, 0}, arc) == PathFault::none);
    PathLimits limits{{1e3, 1e5, 1e7}, {}};
    limits.axes.fill({1e3, 2000, 1e7});
    REQUIRE(path.append(ring, arc, limits) == PathFault::none);
    const auto keeps = [&](double v) {
        PathCourse course;
        std::array<double, 1> quotients{};
        course.add({0, {0, v, 0, 0}, 0}, 60 / v);
        return keeps_limits({ring, 0, 1}, course, 0, quotients);
    };
    CHECK(keeps(0.995 * std::sqrt(2000 * 20.0)));
    CHECK_FALSE(keeps(1.0001 * std::sqrt(2000 * 20.0)));
}

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/path/path.hpp"
#include "tests/blocks/path/path_motions.hpp"
#include "tests/blocks/path/path_random.hpp"
#include "tests/blocks/path/random_path.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

double distance(const PathVector& a, const PathVector& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

PathVector sum(const PathVector& a, double fa, const PathVector& b, double fb) {
    PathVector out{};
    for (std::size_t i = 0; i < path_space; ++i) out[i] = fa * a[i] + fb * b[i];
    return out;
}

/// A line or an arc of 1 to 100 mm, in a plane or in space; arcs by up to nearly the whole circle.
PathCurve random_piece(Random& random, const PathVector& from, bool arc, std::size_t axes) {
    for (;;) {
        const PathVector u = random_direction(random, axes), other = random_direction(random, axes);
        const double size = random.decades(0, 2);
        PathCurve out;
        if (!arc) {
            if (line_to(from, sum(from, 1, u, size), out) == PathFault::none) return out;
            continue;
        }
        double along = 0;
        for (std::size_t i = 0; i < path_space; ++i) along += u[i] * other[i];
        PathVector w = sum(other, 1, u, -along);
        const double upright = distance(w, {});
        if (upright < 0.1) continue;
        const double angle = random.between(0.05, 6.2), radius = size / angle;
        const PathVector centre = sum(from, 1, u, -radius);
        const auto at = [&](double phi) {
            const PathVector off =
                sum(u, radius * std::cos(phi), w, radius * std::sin(phi) / upright);
            return sum(centre, 1, off, 1);
        };
        if (arc_through(from, at(0.5 * angle), at(angle), out) == PathFault::none) return out;
    }
}

/// From a point to the nearest one of 200 of a curve, and of those between them.
double distance_to(const PathVector& x, const PathCurve& curve) {
    constexpr int places = 200;
    int best = 0;
    double least = 1e300;
    for (int k = 0; k <= places; ++k) {
        const double here = distance(x, curve.at(curve.length * k / places).position);
        if (here < least) least = here, best = k;
    }
    double a = curve.length * std::max(0, best - 1) / places,
           b = curve.length * std::min(places, best + 1) / places;
    for (int step = 0; step < 40; ++step) {
        const double c = a + (b - a) / 3, d = b - (b - a) / 3;
        const double at_c = distance(x, curve.at(c).position),
                     at_d = distance(x, curve.at(d).position);
        (at_c < at_d ? b : a) = at_c < at_d ? d : c;
    }
    return std::min(least, distance(x, curve.at(0.5 * (a + b)).position));
}

struct Corner {
    PathCurve before, after;
    PathVector vertex{};
    double deviation = 0;
    std::vector<PathCurve> curves;  ///< what rounds it; none where it is a stop
};

/// How near it comes to its vertex, and how far it is from both pieces.
std::pair<double, double> deviations_of(const Corner& corner) {
    double nearest = 1e300, most = 0;
    const int places = std::max(8, 100 / static_cast<int>(corner.curves.size()));
    for (const PathCurve& c : corner.curves) {
        nearest = std::min(nearest, distance_to(corner.vertex, c));
        for (int k = 0; k <= places; ++k) {
            const PathVector x = c.at(c.length * k / places).position;
            most = std::max(most,
                            std::min(distance_to(x, corner.before), distance_to(x, corner.after)));
        }
    }
    return {nearest, most};
}

void check_smooth(const PathCurve& before, const PathCurve& after) {
    const PathPoint a = before.at(before.length), b = after.at(0);
    double bend = 1 / (before.length + after.length);
    for (std::size_t i = 0; i < path_space; ++i)
        bend = std::max({bend, std::abs(a.bend[i]), std::abs(b.bend[i])});
    for (std::size_t i = 0; i < path_space; ++i) {
        CHECK(std::abs(a.position[i] - b.position[i]) <= 1e-9);
        CHECK(std::abs(a.tangent[i] - b.tangent[i]) <= 1e-9);
        CHECK(std::abs(a.bend[i] - b.bend[i]) <= 1e-9 * bend);
    }
}

/// Two pieces with a corner between, appended at standstill or while the first is run along.
struct RandomCorner {
    Corner corner;
    Path path;
    std::vector<PathPiece> ring = std::vector<PathPiece>(32);
    PathLimits limits;

    explicit RandomCorner(Random& random) {
        const std::size_t axes = random.share() < 0.5 ? 2 : 3;
        limits.path = {random.decades(1, 3), random.decades(2, 4), random.decades(3, 6)};
        for (PathLimit& axis : limits.axes)
            axis = {random.decades(1, 3), random.decades(2, 4), random.decades(3, 6)};
        const double kind = random.share();
        corner.before = random_piece(random, {}, kind < 0.6, axes);
        corner.vertex = corner.before.end;
        corner.after = random_piece(random, corner.vertex, kind < 0.3 || kind > 0.6, axes);
        corner.deviation = random.decades(-3, 1);
        REQUIRE(path.append(ring, corner.before, limits) == PathFault::none);
        if (random.share() < 0.3) {
            path.advance(ring, 0);
            path.advance(ring, random.share() * path.leg.duration());
        }
        PathJoint joint;
        joint.distance = PathJoint::any, joint.deviation = corner.deviation;
        REQUIRE(path.append(ring, corner.after, limits, joint) == PathFault::none);
        for (std::uint64_t k = 1; k + 1 < path.count; ++k) corner.curves.push_back(ring[k].curve);
    }

    std::string run() {
        double length = path.total;
        for (int scan = 0; scan < 100'000 && !path.finished(); ++scan) {
            const double left = std::max(path.leg.duration() - path.time, 0.0);
            const std::string what = violation(path.advance(ring, 0.05 * left + 1e-5), limits);
            if (!what.empty()) return what;
        }
        if (!path.finished() || path.total != length) return "does not end";
        return path.now(ring).position == corner.after.end ? "" : "end";
    }
};

}  // namespace

TEST_CASE(
    "path: random corners of lines and arcs pass the vertex within the deviation, and stay as near "
    "to both") {
    constexpr double rounding = 1e-9;
    double rounded = 0, reached = 0;
    const std::int64_t count = count_of("LINESHAFT_CORNERS", 60);
    for (std::int64_t seed = 0; seed < count; ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        RandomCorner drawn(random);
        const Corner& corner = drawn.corner;
        CAPTURE(seed, corner.deviation, corner.before.radius, corner.after.radius);
        if (!corner.curves.empty()) {
            const auto [nearest, most] = deviations_of(corner);
            CHECK(nearest <= corner.deviation + rounding);
            CHECK(most <= corner.deviation + rounding);
            ++rounded;
            if (std::max(nearest, most) >= 0.9 * corner.deviation) ++reached;
            for (std::uint64_t k = 0; k + 1 < drawn.path.count; ++k)
                check_smooth(drawn.ring[k].curve, drawn.ring[k + 1].curve);
        }
        CHECK(drawn.run() == "");
    }
    CHECK(rounded > 0.75 * static_cast<double>(count));
    CHECK(reached > 0.5 * static_cast<double>(count));
}

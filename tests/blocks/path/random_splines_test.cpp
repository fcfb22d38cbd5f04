#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/group/path_table.hpp"
#include "blocks/path/path.hpp"
#include "tests/blocks/path/path_motions.hpp"
#include "tests/blocks/path/path_random.hpp"
#include "tests/blocks/path/random_path.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// How the points of a spline lie: anywhere, some next to the one before, on lines with reversals,
/// some near the way back, at distances of seven decades.
enum class Spread { anywhere, nearly_one, on_lines, back, decades };

PathVector moved(PathVector from, double way, const PathVector& along) {
    for (std::size_t i = 0; i < path_space; ++i) from[i] += way * along[i];
    return from;
}

std::vector<PathVector> random_points(Random& random, Spread spread) {
    const std::size_t axes = random.share() < 0.5 ? 2 : 3;
    const double size = random.decades(-2, 4);
    const std::size_t count =
        random.share() < 0.5 ? 41 : 2 + static_cast<std::size_t>(random.between(0, 39.99));
    std::vector<PathVector> points{{}};
    for (PathVector along{}; points.size() < count;) {
        const PathVector last = points.back(), direction = random_direction(random, axes);
        const double what = random.share();
        if (spread == Spread::nearly_one && what < 0.3) {
            points.push_back(moved(last, size * random.decades(-12, -1), direction));
        } else if (spread == Spread::on_lines) {
            if (points.size() == 1 || what < 0.2) along = direction;
            const double way = size * random.decades(-3, 0);
            points.push_back(moved(last, random.share() < 0.33 ? -way : way, along));
        } else if (spread == Spread::back && points.size() > 1 && what < 0.4) {
            const double off = random.share() < 0.7 ? size * random.decades(-14, -2) : 0;
            const PathVector back = moved(points[points.size() - 2], -1, last);
            points.push_back(moved(moved(last, random.decades(-2, 1), back), off, direction));
        } else if (spread == Spread::decades) {
            points.push_back(moved(last, random.decades(-3, 4), direction));
        } else {
            points.push_back(moved({}, size * random.share(), direction));
        }
    }
    return points;
}

/// A path along the rows of a table, laid as there is room for it.
struct Laid {
    std::vector<PathTablePoint> rows;
    PathLimits limits;
    std::vector<PathPiece> ring = std::vector<PathPiece>(256);
    Path path;
    double scan = 0;  ///< [s]

    std::string run_to(std::uint64_t piece) {
        constexpr int most_scans = 100'000;
        for (int n = 0; n < most_scans; ++n) {
            if (path.finished() || path.first >= piece) return "";
            path.advance_to(ring, scan, piece);
            if (path.lost) return "lost";
            const PathMotion m = path.now(ring);
            const std::string what = violation(m, limits);
            if (!what.empty()) return what;
            constexpr double ripple = 5e-4;
            const PathVector& v = m.velocity;
            if (std::hypot(v[0], v[1], v[2]) > (1 + ripple) * limits.path.velocity)
                return "velocity in space";
            // Limits of an axis may be decades below those of the path.
            scan *= n % 100 == 99 ? 1.5 : 1;
        }
        return "does not end";
    }

    std::string lay(const PathCurve& curve) {
        for (int place = 0; place <= 8; ++place) {
            const PathVector x = curve.at(curve.length * place / 8).tangent;
            if (!(std::hypot(x[0], x[1], x[2]) <= 1.02)) return "uneven";
        }
        return path.append(ring, curve, limits) == PathFault::none ? "" : "append";
    }

    std::string run() {
        const PathRows table{{rows.data() + 1, rows.size() - 1}, rows.front().target()};
        PathVector from = table.start;
        PathCurve last;
        const PathCurve* before = nullptr;
        for (std::size_t k = 0; k < table.rows.size(); ++k) {
            PathRowCurves curves;
            std::size_t count = 0;
            const PathFault fault = curves_of(table, k, from, before, curves, count);
            if (fault == PathFault::no_length) continue;
            if (fault != PathFault::none) return "row " + std::to_string(k);
            std::string what;
            if (const std::uint64_t needed = path.count + count; needed > ring.size())
                what = run_to(needed - ring.size());
            for (std::size_t i = 0; i < count && what.empty(); ++i) what = lay(curves[i]);
            if (!what.empty()) return what + " at row " + std::to_string(k);
            last = curves[count - 1];
            before = &last;
            from = last.end;
            if (from != table.rows[k].target()) return "not there at row " + std::to_string(k);
        }
        const std::string what = run_to(Path::to_end);
        if (!what.empty()) return what;
        return path.now(ring).position == rows.back().target() ? "" : "end";
    }
};

std::string fault_of_spline(std::uint64_t seed) {
    Random random(seed);
    const auto spread = static_cast<Spread>(random.between(0, 4.999));
    const bool is_cubic = random.share() < 0.5;
    Laid laid;
    for (const PathVector& point : random_points(random, spread)) {
        laid.rows.emplace_back();
        laid.rows.back().position = {point[0], point[1], point[2]};
        laid.rows.back().kind = is_cubic ? PathPointKind::cubic : PathPointKind::spline;
    }
    laid.limits = wide_limits({random.decades(0, 3), random.decades(1, 4), random.decades(2, 6)});
    if (random.share() < 0.5)
        for (PathLimit& axis : laid.limits.axes)
            axis = {random.decades(0, 3), random.decades(1, 4), random.decades(2, 6)};
    laid.scan = random.decades(-3, -1);
    return laid.run();
}

/// In a plane, from a point to the nearest of a curve's.
double distance_to_points(const PathVector& x, const std::vector<PathVector>& curve) {
    double least = 1e300;
    for (const PathVector& y : curve)
        least = std::min(least, (x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]));
    return std::sqrt(least);
}

}  // namespace

TEST_CASE("path: random splines are planned and end, within limits") {
    const std::int64_t first = count_of("LINESHAFT_SEED", 0);
    const std::int64_t count = count_of("LINESHAFT_SPLINES", 40);
    for (std::int64_t seed = first; seed < first + count; ++seed) {
        INFO("seed " << seed);
        CHECK(fault_of_spline(static_cast<std::uint64_t>(seed)) == "");
    }
}

/// x' and y' are 0 in the middle where `miss` is 0, and nearly so next to it.
TEST_CASE("path_spline: a cusp is run into and out of, and a turn next to one") {
    for (int decade = 1; decade <= 17; ++decade)
        for (const double sign : {-1.0, 1.0}) {
            const double miss = decade == 17 ? 0 : sign * std::pow(10, -decade);
            CAPTURE(miss);
            PathPoint from, to;
            from.tangent = {15.0 / 7 * (1 + miss), 15.0 / 7 * (1 + miss)};
            to.position = {1};
            to.tangent = {from.tangent[0], -from.tangent[1]};
            std::vector<PathVector> wanted;
            for (int k = 0; k <= 4000; ++k) {
                const double t = k / 4000.0, a = from.tangent[0];
                const double d0 = t * (1 - t * t * (6 - t * (8 - 3 * t)));
                const double d1 = -t * t * t * (4 - t * (7 - 3 * t));
                wanted.push_back(
                    {t * t * t * (10 - t * (15 - 6 * t)) + a * (d0 + d1), a * (d0 - d1)});
            }
            std::array<PathCurve, most_spline_parts> parts;
            const std::size_t count = quintic_between(from, to, parts);
            REQUIRE(count > 0);
            for (std::size_t i = 0; i < count; ++i)
                for (int k = 0; k <= 8; ++k)
                    CHECK(distance_to_points(parts[i].at(parts[i].length * k / 8).position,
                                             wanted) <= 5e-4);
        }
}

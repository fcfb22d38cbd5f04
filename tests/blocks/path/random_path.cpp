#include "tests/blocks/path/random_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "blocks/path/path_cubic.hpp"
#include "blocks/path/path_spline.hpp"

namespace lineshaft::test {

namespace {

PathVector random_point(Random& random, std::size_t axes, double size) {
    PathVector x{};
    for (std::size_t i = 0; i < axes; ++i) x[i] = random.between(-size, size);
    return x;
}

PathJoint random_joint(Random& random, double size) {
    if (random.share() < 0.2) return {random.share() < 0.5 ? 0 : random.decades(-2, 2), 0};
    return {0, size * random.decades(-4, 0)};
}

/// With the tangent of the last one, or that of a line to the point; the part of a spline that a
/// longer one would have.
void append_spline(RandomPath& out, Random& random, const PathVector& from, const PathVector& to,
                   const PathLimits& limits) {
    const PathVector beyond = random_point(random, 3, std::abs(to[0]) + 1);
    PathPoint begin = waypoint(from, from, to);
    if (!out.curves.empty() && random.share() < 0.7)
        begin = out.curves.back().at(out.curves.back().length);
    std::array<PathCurve, most_spline_parts> parts;
    const std::size_t count = spline_between(begin, waypoint(from, to, beyond), parts);
    for (std::size_t i = 0; i < count; ++i) {
        out.curves.push_back(parts[i]);
        out.limits.push_back(limits);
    }
}

/// Through two to six random points.
void append_cubic(RandomPath& out, Random& random, const PathVector& from, std::size_t axes,
                  double size, const PathLimits& limits) {
    std::vector<PathVector> points{from};
    for (auto more = 1 + static_cast<int>(random.between(0, 4.999)); more > 0; --more)
        points.push_back(random_point(random, axes, size));
    std::array<PathCurve, most_spline_parts> parts;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const std::size_t count = cubic_between(knot_of(points, k), knot_of(points, k + 1), parts);
        if (count == 0) return;
        out.curves.insert(out.curves.end(), parts.begin(),
                          parts.begin() + static_cast<std::ptrdiff_t>(count));
        out.limits.resize(out.curves.size(), limits);
    }
}

}  // namespace

PathVector random_direction(Random& random, std::size_t axes) {
    for (;;) {
        PathVector x{};
        for (std::size_t i = 0; i < axes; ++i) x[i] = random.between(-1, 1);
        const double size = std::hypot(x[0], x[1], x[2]);
        if (size < 0.1 || size > 1) continue;
        for (double& part : x) part /= size;
        return x;
    }
}

RandomPath random_path(Random& random, std::size_t most) {
    RandomPath out;
    const auto axes = static_cast<std::size_t>(random.between(2, 6.999));
    const double size = random.decades(-2, 3);
    PathLimits limits{{random.decades(-1, 3), random.decades(-1, 4), random.decades(0, 6)}, {}};
    for (PathLimit& axis : limits.axes) {
        axis = {random.decades(-1, 3), random.decades(-1, 4), random.decades(0, 6)};
    }
    const double mean = random.share() < 0.05 ? 200 : 15;
    const auto wanted = std::min<double>(500, 1 - mean * std::log(1 - random.share()));
    PathVector from = random_point(random, axes, size);
    while (static_cast<double>(out.curves.size()) < wanted && out.curves.size() < most) {
        const PathVector to = random_point(random, axes, size);
        PathCurve curve;
        const double kind = random.share();
        if (kind < 0.2) {
            if (kind < 0.1)
                append_spline(out, random, from, random_point(random, axes, size), limits);
            else
                append_cubic(out, random, from, axes, size, limits);
            if (!out.curves.empty()) from = out.curves.back().end;
            while (out.joints.size() < out.curves.size()) out.joints.push_back({});
            continue;
        }
        const bool line = random.share() < 0.5;
        if ((line ? line_to(from, to, curve)
                  : arc_through(from, random_point(random, axes, size), to, curve)) !=
            PathFault::none) {
            continue;
        }
        PathCurve half;
        if (line && random.share() < 0.5 &&
            line_to(from, curve.at(curve.length * random.share()).position, half) ==
                PathFault::none &&
            line_to(half.end, to, curve) == PathFault::none) {
            out.curves.push_back(half);
            out.limits.push_back(limits);
        }
        out.curves.push_back(curve);
        out.limits.push_back(limits);
        while (out.joints.size() < out.curves.size())
            out.joints.push_back(random.share() < 0.5 ? PathJoint{} : random_joint(random, size));
        from = to;
    }
    return out;
}

}  // namespace lineshaft::test

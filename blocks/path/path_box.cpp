#include "blocks/path/path_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <sleef.h>

#include "blocks/path/path_bound.hpp"
#include "blocks/profile/seven_segment.hpp"

namespace lineshaft {

namespace {

bool good(double limit) {
    return std::isfinite(limit) && limit > 0;
}

/// What the axes allow along the tangent alone: the least quotient of limit and share.
PathLimit tangential(const PathCurve& curve, const PathLimits& limits) {
    constexpr double none = std::numeric_limits<double>::infinity();
    PathLimit least{none, none, none};
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const double share = curve.share(i);
        if (share == 0) continue;
        least.velocity = std::min(least.velocity, limits.axes[i].velocity / share);
        least.acceleration = std::min(least.acceleration, limits.axes[i].acceleration / share);
        least.jerk = std::min(least.jerk, limits.axes[i].jerk / share);
    }
    return least;
}

/// What bounds of an axis' derivatives, or of the whole vector's, belong to which limit.
struct Bounded : PathBound {
    PathLimit limit;
    double lean = 0;  ///< in a corner, at most: the part of the tangent that lies along the bend

    /// What a limit leaves along the tangent beside so much along the bend.
    double left(double most, double along_bend) const {
        const double part = along_bend / most, rest = (1 - part) * (1 + part);
        const double beside = lean * part;
        return most * (rest / (beside + std::sqrt(beside * beside + tangent * tangent * rest)));
    }
};

using AllBounded = std::array<Bounded, most_path_axes + 1>;

/// Parts of a limit that the curvature alone may take: a corner is passed at nearly one speed.
constexpr double of_acceleration = 0.9, of_jerk = 0.93, of_jerk_in_spline = 0.8;

/// The greatest part along w - u that a tangent in space on the way from u to w has.
double lean_between(const PathCurve& u, const PathCurve& w, double turn) {
    double first = 0, last = 0;
    for (std::size_t i = 0; i < path_space; ++i) {
        first += u.u[i] * (w.u[i] - u.u[i]);
        last += w.u[i] * (w.u[i] - u.u[i]);
    }
    return turn > 0 ? std::max(std::abs(first), std::abs(last)) / turn : 0;
}

AllBounded bounds_of_corner(const PathCurve& u, const PathCurve& w, double length,
                            const PathLimits& limits) {
    const auto bound = [&](double tangent, double turn, const PathLimit& limit, double lean) {
        return Bounded{
            {tangent, 1.5 * turn / length, 6 * turn / (length * length), 0, 0}, limit, lean};
    };
    const double turn = bend_between(u, w);
    AllBounded out{bound(1, turn, limits.path, lean_between(u, w, turn))};
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const double tangent = std::max(std::abs(u.u[i]), std::abs(w.u[i]));
        out[i + 1] = bound(tangent, std::abs(w.u[i] - u.u[i]), limits.axes[i], tangent);
    }
    return out;
}

/// In a corner the bend is greatest where there is no twist, and the other way round: what both
/// come to together at most.
double jerk_along_bend(double by_bend, double by_twist) {
    return by_twist >= 2 * by_bend ? by_twist : by_bend + by_twist * by_twist / (4 * by_bend);
}

/// The box of README.md, "Corners".
PathLimit corner_box(const AllBounded& bounds, const PathLimit& most) {
    constexpr double for_bend = 0.5, no_limit = std::numeric_limits<double>::infinity();
    PathLimit box = most;
    double square = no_limit, cube = no_limit;  ///< of the velocity
    for (const Bounded& b : bounds) {
        if (b.tangent == 0) continue;
        box.velocity = std::min(box.velocity, b.limit.velocity / b.tangent);
        if (b.bend == 0) continue;
        square = std::min(square, of_acceleration * b.limit.acceleration / b.bend);
        cube = std::min(cube, of_jerk * b.limit.jerk / b.twist);
    }
    if (square < no_limit)
        box.velocity =
            std::min({box.velocity, std::sqrt(square), Sleef_cinz_cbrtd1_u10purec(cube)});
    const double V = box.velocity;
    for (const Bounded& b : bounds) {
        if (b.tangent == 0) continue;
        box.acceleration = std::min(box.acceleration, b.left(b.limit.acceleration, b.bend * V * V));
        if (b.bend == 0) continue;
        const double by_twist = b.twist * V * V * V;
        const double all = std::max(by_twist, for_bend * b.limit.jerk);
        const double by_bend = 0.5 * (all + std::sqrt((all - by_twist) * (all + by_twist)));
        box.acceleration = std::min(box.acceleration, by_bend / (3 * b.bend * V));
    }
    for (const Bounded& b : bounds) {
        if (b.tangent == 0) continue;
        const double by_bend = 3 * b.bend * V * box.acceleration, by_twist = b.twist * V * V * V;
        box.jerk = std::min(box.jerk, b.left(b.limit.jerk, jerk_along_bend(by_bend, by_twist)));
    }
    return box;
}

AllBounded bounds_of_spline(const PathCurve& spline, const PathLimits& limits) {
    AllBounded out{Bounded{{1, 0, 0, 0, 0}, limits.path}};
    const PathBounds bounds = bounds_of(spline);
    for (std::size_t i = 0; i < most_path_axes; ++i) out[i + 1] = {bounds[i], limits.axes[i]};
    return out;
}

/// The box of README.md, "Splines and transitions", with this part of the greatest velocity.
PathLimit box_of_spline(const AllBounded& bounds, double part, const PathLimit& most) {
    PathLimit box = most;
    for (const Bounded& b : bounds) {
        if (b.tangent == 0) continue;
        box.velocity = std::min(box.velocity, b.limit.velocity / b.tangent);
        if (b.bend > 0)
            box.velocity = std::min(
                box.velocity, part * std::sqrt(of_acceleration * b.limit.acceleration / b.bend));
        if (b.twist > 0)
            box.velocity = std::min(
                box.velocity,
                part * Sleef_cinz_cbrtd1_u10purec(of_jerk_in_spline * b.limit.jerk / b.twist));
    }
    const double V = box.velocity;
    for (const Bounded& b : bounds) {
        if (b.tangent == 0) continue;
        const double twist = b.limit.jerk - b.twist * V * V * V;
        box.acceleration =
            std::min(box.acceleration, (b.limit.acceleration - b.bend * V * V) / b.tangent);
        if (b.bend > 0)
            box.acceleration = std::min(box.acceleration, 0.5 * twist / (3 * b.bend * V));
    }
    const double A = box.acceleration;
    for (const Bounded& b : bounds) {
        if (b.tangent == 0) continue;
        const double left = b.limit.jerk - 3 * b.bend * V * A - b.twist * V * V * V;
        box.jerk = std::min(box.jerk, left / b.tangent);
    }
    return box;
}

/// The box of README.md, "Arcs", with this velocity.
PathLimit box_on_arc(double V, double R, const PathLimit& axes, const PathLimit& most) {
    const double inwards = V * V / R, twist = V * V / R * (V / R);
    const double left = std::sqrt((axes.acceleration - inwards) * (axes.acceleration + inwards));
    const double A = std::min({most.acceleration, left, 0.2 * axes.jerk * R / V});
    const double both = 3 * V * A / R;
    const double J = std::sqrt((axes.jerk - both) * (axes.jerk + both)) - twist;
    return {V, A, std::min(most.jerk, J)};
}

/// The one of boxes with several parts of the greatest velocity with which a curve alone, from
/// stop to stop, is run along in the least time; all 0 where there is none.
template <class Box>
PathLimit soonest(double length, const Box& box_with) {
    PathLimit best{0, 0, 0};
    double least = std::numeric_limits<double>::infinity();
    for (const double part : {1.0, 0.95, 0.87, 0.77, 0.65, 0.5}) {
        const PathLimit box = box_with(part);
        SevenSegmentPlan alone;
        const SevenSegment problem{0, 0, box.velocity, box.acceleration, box.jerk, length};
        if (plan(problem, alone) != PlanResult::ok || alone.duration >= least) continue;
        least = alone.duration;
        best = box;
    }
    return best;
}

}  // namespace

bool is_good(const PathLimit& limit) {
    return good(limit.velocity) && good(limit.acceleration) && good(limit.jerk);
}

PathLimit box_of_corner(const PathCurve& before, const PathCurve& after, double length,
                        const PathLimits& limits) {
    return corner_box(bounds_of_corner(before, after, length, limits), limits.path);
}

PathLimit box_of(const PathCurve& curve, const PathLimits& limits) {
    if (curve.kind == PathCurveKind::spline) {
        const AllBounded bounds = bounds_of_spline(curve, limits);
        return soonest(curve.length,
                       [&](double part) { return box_of_spline(bounds, part, limits.path); });
    }
    const PathLimit axes = tangential(curve, limits);
    const PathLimit most = least_of(limits.path, axes);
    if (curve.kind == PathCurveKind::line) return most;
    const double R = curve.radius;
    const double steady = Sleef_cinz_cbrtd1_u10purec(0.5 * axes.jerk * R * R);
    const double V = std::min({most.velocity, std::sqrt(0.98 * axes.acceleration * R), steady});
    return soonest(curve.length, [&](double part) { return box_on_arc(part * V, R, axes, most); });
}

PathLimit least_of(const PathLimit& a, const PathLimit& b) {
    return {std::min(a.velocity, b.velocity), std::min(a.acceleration, b.acceleration),
            std::min(a.jerk, b.jerk)};
}

PathLimits limits_between(const PathLimits& before, const PathLimits& after, PathBlend blend) {
    PathLimits out{least_of(before.path, after.path), {}};
    if (blend == PathBlend::previous) out.path = before.path;
    if (blend == PathBlend::next) out.path = after.path;
    if (blend == PathBlend::high)
        out.path = {std::max(before.path.velocity, after.path.velocity),
                    std::max(before.path.acceleration, after.path.acceleration),
                    std::max(before.path.jerk, after.path.jerk)};
    for (std::size_t i = 0; i < most_path_axes; ++i)
        out.axes[i] = least_of(before.axes[i], after.axes[i]);
    return out;
}

PathLimits limits_on(const PathCurve& curve, const PathLimits& limits) {
    constexpr int places = 64;
    constexpr double even = 1 + 4e-4;
    PathLimits out = limits;
    if (curve.kind != PathCurveKind::spline) return out;
    double most = 1;
    for (int k = 0; k <= places; ++k) {
        const PathVector tangent = curve.at(curve.length * k / places).tangent;
        most = std::max(most, std::hypot(tangent[0], tangent[1], tangent[2]));
    }
    if (most > even) out.path.velocity /= most;
    return out;
}

double corner_distance_at(double velocity, const PathCurve& before, const PathCurve& after,
                          const PathLimits& limits) {
    double distance = 0;
    for (const Bounded& b : bounds_of_corner(before, after, 1, limits)) {
        if (b.tangent == 0) continue;
        const double square = velocity * velocity;
        const double by_acceleration =
            0.5 * b.bend * square / (of_acceleration * b.limit.acceleration);
        const double by_jerk =
            0.5 * std::sqrt(b.twist * square * velocity / (of_jerk * b.limit.jerk));
        distance = std::max({distance, by_acceleration, by_jerk});
    }
    return distance;
}

}  // namespace lineshaft

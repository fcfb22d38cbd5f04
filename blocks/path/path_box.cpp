#include "blocks/path/path_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <sleef.h>

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

/// Greatest sizes of an axis' first three derivatives by s in a corner, or of the whole vector's;
/// its limit.
struct CornerBound {
    double tangent = 0, bend = 0, twist = 0;
    PathLimit limit;
};

/// Parts of a limit that the curvature alone may take, and the product of speed and acceleration: a
/// corner is passed at nearly one speed.
constexpr double of_acceleration = 0.9, of_jerk = 0.8, of_jerk_by_both = 0.1;

template <class Use>
void for_bounds(const PathCurve& u, const PathCurve& w, double length, const PathLimits& limits,
                const Use& use) {
    const auto bound = [&](double tangent, double turn, const PathLimit& limit) {
        if (tangent == 0) return;
        use(CornerBound{tangent, 1.5 * turn / length, 6 * turn / (length * length), limit});
    };
    bound(1, bend_between(u, w), limits.path);
    for (std::size_t i = 0; i < most_path_axes; ++i)
        bound(std::max(std::abs(u.u[i]), std::abs(w.u[i])), std::abs(w.u[i] - u.u[i]),
              limits.axes[i]);
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

}  // namespace

bool is_good(const PathLimit& limit) {
    return good(limit.velocity) && good(limit.acceleration) && good(limit.jerk);
}

PathLimit box_of_corner(const PathCurve& before, const PathCurve& after, double length,
                        const PathLimits& limits, const PathLimit& most) {
    PathLimit cap = most;
    for_bounds(before, after, length, limits, [&](const CornerBound& b) {
        cap.velocity = std::min(cap.velocity, b.limit.velocity / b.tangent);
        if (b.bend == 0) return;
        cap.velocity =
            std::min({cap.velocity, std::sqrt(of_acceleration * b.limit.acceleration / b.bend),
                      Sleef_cinz_cbrtd1_u10purec(of_jerk * b.limit.jerk / b.twist)});
    });
    const double V = cap.velocity;
    for_bounds(before, after, length, limits, [&](const CornerBound& b) {
        const double left = b.limit.acceleration - b.bend * V * V;
        cap.acceleration = std::min(cap.acceleration, left / b.tangent);
        if (b.bend > 0)
            cap.acceleration =
                std::min(cap.acceleration, of_jerk_by_both * b.limit.jerk / (3 * b.bend * V));
    });
    const double A = cap.acceleration;
    for_bounds(before, after, length, limits, [&](const CornerBound& b) {
        const double left = b.limit.jerk - 3 * b.bend * V * A - b.twist * V * V * V;
        cap.jerk = std::min(cap.jerk, left / b.tangent);
    });
    return cap;
}

PathLimit box_of(const PathCurve& curve, const PathLimits& limits) {
    const PathLimit axes = tangential(curve, limits);
    const PathLimit most = least_of(limits.path, axes);
    if (curve.kind == PathCurveKind::line) return most;
    const double R = curve.radius;
    const double steady = Sleef_cinz_cbrtd1_u10purec(0.5 * axes.jerk * R * R);
    const double V = std::min({most.velocity, std::sqrt(0.98 * axes.acceleration * R), steady});
    PathLimit best;
    double least = std::numeric_limits<double>::infinity();
    for (const double part : {1.0, 0.95, 0.87, 0.77, 0.65, 0.5}) {
        const PathLimit box = box_on_arc(part * V, R, axes, most);
        SevenSegmentPlan alone;
        const SevenSegment problem{0, 0, box.velocity, box.acceleration, box.jerk, curve.length};
        if (plan(problem, alone) != PlanResult::ok || alone.duration >= least) continue;
        least = alone.duration;
        best = box;
    }
    return least < std::numeric_limits<double>::infinity() ? best : PathLimit{0, 0, 0};
}

PathLimit least_of(const PathLimit& a, const PathLimit& b) {
    return {std::min(a.velocity, b.velocity), std::min(a.acceleration, b.acceleration),
            std::min(a.jerk, b.jerk)};
}

double corner_distance_at(double velocity, const PathCurve& before, const PathCurve& after,
                          const PathLimits& limits) {
    double distance = 0;
    for_bounds(before, after, 1, limits, [&](const CornerBound& b) {
        const double square = velocity * velocity;
        const double by_acceleration =
            0.5 * b.bend * square / (of_acceleration * b.limit.acceleration);
        const double by_jerk =
            0.5 * std::sqrt(b.twist * square * velocity / (of_jerk * b.limit.jerk));
        distance = std::max({distance, by_acceleration, by_jerk});
    });
    return distance;
}

}  // namespace lineshaft

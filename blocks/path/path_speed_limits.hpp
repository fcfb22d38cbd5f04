#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "blocks/path/path_speed.hpp"

/// What bounds the motion at a place of an interval. With w = v^2/2 each acceleration is tangent w'
/// + 2 bend w, each jerk v (tangent w'' + 3 bend w' + 2 twist w).
namespace lineshaft::speed_limits {

inline constexpr double no_limit = 1e200;

/// A direction in the plane of a corner.
struct Across {
    double cosine, sine;

    double part(const PathVector& x, const std::array<PathVector, 2>& plane) const {
        double sum = 0;
        for (std::size_t i = 0; i < path_space; ++i)
            sum += x[i] * (cosine * plane[0][i] + sine * plane[1][i]);
        return sum;
    }
};

/// The limits of the path hold for the whole vector in a corner: a polygon of 16 sides within the
/// circle.
inline constexpr double c1 = 0.9238795325112867, c2 = 0.7071067811865476, c3 = 0.3826834323650898;
inline constexpr Across polygon[] = {{1, 0}, {c1, c3},  {c2, c2},  {c3, c1},
                                     {0, 1}, {-c3, c1}, {-c2, c2}, {-c1, c3}};
inline constexpr double polygon_share = 0.9807852804032304;  ///< cos(pi/16)

/// Calls `use(tangent, bend, twist, limit)` for all that is bounded by a limit of one kind.
template <class Use>
void each_bounded(const SpeedInterval& here, const PathPoint& x, double PathLimit::*of,
                  const Use& use) {
    if (here.kind == PathCurveKind::line) return use(1, 0, 0, here.along.*of);
    const double path = here.limits->path.*of;
    use(1, 0, 0, path);
    if (here.kind == PathCurveKind::corner && path < no_limit)
        for (const Across& side : polygon)
            use(side.part(x.tangent, here.plane), side.part(x.bend, here.plane),
                side.part(x.twist, here.plane), polygon_share * path);
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (x.tangent[i] != 0 || x.bend[i] != 0 || x.twist[i] != 0)
            use(x.tangent[i], x.bend[i], x.twist[i], here.limits->axes[i].*of);
}

/// What is left of the velocity at a point where all limits of acceleration are kept.
inline double fastest_at(const SpeedInterval& here, const PathPoint& x) {
    const double v = here.along.velocity, A = here.limits->path.acceleration;
    double energy = 0.5 * v * v;
    each_bounded(
        here, x, &PathLimit::acceleration, [&](double tangent, double bend, double, double limit) {
            if (bend != 0)
                energy = std::min(energy, (limit + std::abs(tangent) * A) / (2 * std::abs(bend)));
        });
    return std::sqrt(2 * energy);
}

/// A part of the limits that are left when they have been tightened.
inline constexpr double tightened = 0.8;

/// Calls `use(tangent, bend, limit)` for all accelerations that the others do not keep small.
template <class Use>
void each_acceleration(const SpeedInterval& here, const PathPoint& x, const Use& use) {
    const double A = here.limits->path.acceleration, v = fastest_at(here, x);
    bool is_first = true;
    each_bounded(here, x, &PathLimit::acceleration,
                 [&](double tangent, double bend, double, double limit) {
                     const double most = std::abs(tangent) * A + std::abs(bend) * v * v;
                     if (limit < no_limit && (is_first || !(most < tightened * limit)))
                         use(tangent, bend, limit);
                     is_first = false;
                 });
}

/// Likewise with the twist for all jerks.
template <class Use>
void each_jerk(const SpeedInterval& here, const PathPoint& x, const Use& use) {
    const PathLimit& path = here.limits->path;
    const double v = fastest_at(here, x);
    bool is_first = true;
    each_bounded(here, x, &PathLimit::jerk,
                 [&](double tangent, double bend, double twist, double limit) {
                     const double most = std::abs(tangent) * path.jerk +
                                         3 * std::abs(bend) * v * path.acceleration +
                                         std::abs(twist) * v * v * v;
                     if (limit < no_limit && (is_first || !(most < tightened * limit)))
                         use(tangent, bend, twist, limit);
                     is_first = false;
                 });
}

}  // namespace lineshaft::speed_limits

#pragma once

#include <array>
#include <limits>

#include "blocks/path/path_curve.hpp"

namespace lineshaft {

struct PathLimit {
    double velocity = 1, acceleration = 1, jerk = 1;  ///< all > 0 [u/s^n]
};

/// Limits of the motion along the path and of each axis; they hold together at any instant.
struct PathLimits {
    PathLimit path;
    std::array<PathLimit, most_path_axes> axes;
};

inline constexpr PathLimit no_path_limit{1e300, 1e300, 1e300};

/// Whose limits along the path count where a joint is rounded: the lesser, those of the piece
/// before, of the piece behind, or the greater.
enum class PathBlend : std::int64_t { low, previous, next, high };

/// All three are above 0 and finite.
bool is_good(const PathLimit& limit);

PathLimit least_of(const PathLimit& a, const PathLimit& b);
/// Where a joint is rounded; of each axis the lesser.
PathLimits limits_between(const PathLimits& before, const PathLimits& after, PathBlend blend);

/// Those of the motion along a curve: where the length of a spline's tangent is not 1, so that the
/// way in space is run along faster, the velocity is as much lower.
PathLimits limits_on(const PathCurve& curve, const PathLimits& limits);

/// The box of a line or an arc: while 0 <= s' <= velocity, |s''| <= acceleration and |s'''| <= jerk
/// all limits are kept (README.md, "Why no limit is passed").
PathLimit box_of(const PathCurve& curve, const PathLimits& limits);

/// The box of the corner of this length between two lines.
PathLimit box_of_corner(const PathCurve& before, const PathCurve& after, double length,
                        const PathLimits& limits);

/// How far from the vertex a corner may begin that is passed with `velocity` [u/s].
double corner_distance_at(double velocity, const PathCurve& before, const PathCurve& after,
                          const PathLimits& limits);

}  // namespace lineshaft

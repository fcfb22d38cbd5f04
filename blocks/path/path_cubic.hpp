#pragma once

#include <span>

#include "blocks/path/path_spline.hpp"

namespace lineshaft {

/// How many points on either side of one count for its knot: one further away would count for less
/// than 2^-24 of its chord's direction, and among even chords for less than 2^-45.
inline constexpr std::size_t cubic_reach = 24;

/// A point of a spline with its derivatives by the spline's parameter, the sum of chords.
struct PathKnot {
    PathVector position{};
    PathVector first{}, second{};

    PathPoint point() const;  ///< by the length, where the spline begins or ends: without curvature
};

/// At points[at], of 2 * cubic_reach + 1 at most, of the natural cubic spline through them: x, x'
/// and x'' go on at each, and x'' is 0 at the first and the last. Neighbours are apart in the first
/// three axes.
PathKnot knot_of(std::span<const PathVector> points, std::size_t at);

/// What is between two knots, in parts as those of `spline_between`.
std::size_t cubic_between(const PathKnot& from, const PathKnot& to,
                          std::span<PathCurve, most_spline_parts> out);

}  // namespace lineshaft

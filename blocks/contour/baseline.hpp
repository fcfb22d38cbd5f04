#pragma once

#include <cstddef>
#include <span>

#include "blocks/circle/arc.hpp"

namespace lineshaft {

/// Shortest distance from `p` to the polyline's segments beside its point `nearest` (Li et al.,
/// linear interpolation). Lengths in the unit of the points; at least one point.
double polyline_distance(std::span<const Point> points, std::size_t nearest, Point p);

/// One span of a cubic spline: s(t) = c[0] + c[1] t + c[2] t^2 + c[3] t^3, t = 0 .. 1.
struct SplineSpan {
    Point c[4];

    Point at(double t) const;
};

/// The natural cubic spline through points, one for each coordinate over the chord length:
/// s'' = 0 at both ends, s'' continuous in between (Li et al., cubic spline interpolation, here
/// parametric, so that the path may close or stand upright). Points that follow each other differ.
/// `spans` takes one span less than there are points. The tridiagonal system for s'' is eliminated
/// in place (Thomas): no memory beyond the spans, in time proportional to them.
void natural_spline(std::span<const Point> points, std::span<SplineSpan> spans);

/// Shortest distance from `p` to the spans beside the point `nearest`: over each, the least
/// |p - s(t)| of the ends and of all points where (s(t) - p) s'(t), a polynomial of degree 5,
/// changes its sign. At least one span.
double spline_distance(std::span<const SplineSpan> spans, std::size_t nearest, Point p);

}  // namespace lineshaft

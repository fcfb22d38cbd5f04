#pragma once

#include <span>

#include "blocks/path/path_curve.hpp"

namespace lineshaft {

/// Over how many curves a spline is divided at most, so that each is run along evenly.
inline constexpr std::size_t most_spline_parts = 32;

/// Over how many a transition is, between lines and arcs.
inline constexpr std::size_t most_transition_parts = 16;

/// A curve of degree five from a point to another, with their tangents and curvatures: x(s), x' and
/// x'' go on through both. Each of the parts, halves, quarters and so on, has as its length
/// that of the way of the first three axes, and runs along it with |x'| = 1 up to 1e-4, or where
/// the parts would not suffice up to 4e-4, 2e-3 or 1e-2. Returns how many of `out` there are; 0
/// where the points are one, a tangent is 0, or the parts are too few.
std::size_t spline_between(const PathPoint& from, const PathPoint& to,
                           std::span<PathCurve, most_spline_parts> out);

/// The same by the curve's own parameter, from 0 to 1: tangent and bend are the derivatives by it.
std::size_t quintic_between(const PathPoint& from, const PathPoint& to,
                            std::span<PathCurve, most_spline_parts> out);

/// Tangent and curvature at a point between two others, those of the circle through all three in
/// the first three axes. At the first of them, `before` is `at` and they are those of the line
/// there; likewise at the last one. Not where the way turns back.
PathPoint waypoint(const PathVector& before, const PathVector& at, const PathVector& after);

/// Between two points, in the first three axes [u].
double distance(const PathVector& a, const PathVector& b);

/// In the first three axes: b is against a, up to the sine 1e-6 of an angle.
bool turns_back(const PathVector& a, const PathVector& b);

/// How far from the joint of two lines or arcs, `most` at most, a corner or a transition may begin
/// and end that passes the vertex within `deviation` and stays as near to both [u]; 0 where there
/// is none.
double distance_within(double deviation, const PathCurve& before, const PathCurve& after,
                       double most);

}  // namespace lineshaft

#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "blocks/profile/curve.hpp"

namespace lineshaft {

/// How a cam goes from one point to the next.
enum class CamCurve : std::int64_t {
    linear,   ///< a line
    cubic,    ///< position and velocity of both points
    quintic,  ///< position, velocity and acceleration of both points
};

inline constexpr std::string_view cam_curve_names[] = {"linear", "cubic", "quintic"};

/// A point of a cam. Where a velocity y' is not given (NaN) it is the slope of a line beside the
/// point, else that of the spline whose acceleration does not jump; an acceleration y'' that of the
/// curves through the points, the mean of both sides. At the ends of a cam that is not periodic the
/// spline has acceleration 0.
struct CamPoint {
    double x = 0, y = 0;                 ///< master [m], slave [u]
    double slope = NAN, bend = NAN;      ///< y' [u/m], y'' [u/m^2]; may be NaN
    CamCurve curve = CamCurve::quintic;  ///< to the next point
};

enum class CamFault : std::int64_t {
    none,
    too_few_points,  ///< fewer than 2
    not_finite,      ///< a position is NaN, or a number is infinite
    not_monotonic,   ///< the master does not rise from the point before
};

struct CamProblem {
    CamFault fault = CamFault::none;
    std::size_t point = 0;  ///< first one that it is true of
};

inline constexpr std::size_t most_cam_points = 1024;

/// Puts in what is not given. On failure the points are unchanged. At most most_cam_points.
CamProblem complete_cam(std::span<CamPoint> points, bool periodic);

/// The greatest sizes of y and its derivatives within the curves, and of the jumps of y' and y'' at
/// the points.
struct CamExtremes {
    double y = 0, slope = 0, bend = 0, twist = 0;
    double slope_jump = 0, bend_jump = 0;
};

/// Slave over master, of points that are complete. A periodic cam goes on beyond its ends, each
/// period by `lift` further; another one stands there.
struct Cam {
    std::span<const CamPoint> points;
    bool periodic = false;
    double falls = 0;  ///< how much lower than at its end it begins anew: the slave jumps [u]

    double begin() const { return points.front().x; }
    double length() const { return points.back().x - points.front().x; }
    double lift() const { return points.back().y - points.front().y - falls; }

    /// How often the cam has been run through at x; 0 within it.
    double periods(double x) const;
    CurvePoint at(double x) const;

    /// The last point of a cam that is not periodic, as the curve comes there.
    CurvePoint last() const;
    /// The integral of y from the first point to x, within the cam.
    double area(double x) const;
    /// The integral of that.
    double area_of_areas(double x) const;
    CamExtremes extremes() const;
    /// Between what y stays.
    Range values() const;
    /// Between what the integral of scale * y + offset stays, from the first point on.
    Range areas(double scale, double offset) const;
    /// The same of the integral of that, which begins with a slope.
    Range areas_of_areas(double scale, double offset, double slope) const;
};

}  // namespace lineshaft

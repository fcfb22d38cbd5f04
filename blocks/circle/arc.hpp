#pragma once

namespace lineshaft {

enum class Coordinate { x, y };

struct Point {
    double x = 0, y = 0;

    double along(Coordinate c) const { return c == Coordinate::x ? x : y; }
};

/// An arc about (0, 0), over an angle theta from its start:
///     phi(theta) = start + direction * theta,   x = R sin phi,   y = R cos phi
/// so that angle 0 is the point (0, R) and `direction` +1 is clockwise (Wei et al. 2025, eq. (5)).
struct Arc {
    double radius = 1;     ///< [mm]
    double start = 0;      ///< phi of the start point [rad]
    double direction = 1;  ///< +1 clockwise, -1 counter-clockwise
    /// The point at theta, on a circle of `rho` instead of the radius.
    Point at(double theta, double rho) const;
    Point at(double theta) const { return at(theta, radius); }
    /// d(x, y)/d theta at theta [mm/rad].
    Point slope(double theta) const;
};

}  // namespace lineshaft

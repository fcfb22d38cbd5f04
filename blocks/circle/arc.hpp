#pragma once

#include <cstdint>

namespace lineshaft {

enum class Coordinate { x, y };

struct Point {
    double x = 0, y = 0;

    double along(Coordinate c) const { return c == Coordinate::x ? x : y; }
};

/// An arc about (0, 0), cut into n equal steps of the master's angle theta = 0 .. sweep:
///     phi(theta) = start + direction * theta,   x = R sin phi,   y = R cos phi
/// so that angle 0 is the point (0, R) and `direction` +1 is clockwise (Wei et al. 2025, eq. (5)).
struct Arc {
    double radius = 1;       ///< [mm]
    double start = 0;        ///< phi of the start point [rad]
    double direction = 1;    ///< +1 clockwise, -1 counter-clockwise
    double sweep = 0;        ///< theta_n [rad], > 0
    std::int64_t steps = 1;  ///< n = round(sweep R / step), 1 .. 10^9

    /// From `start` to `end` [rad]; clockwise when end > start. step: wanted length of a step [mm].
    static Arc between(double radius, double start, double end, double step);

    double step_angle() const { return sweep / static_cast<double>(steps); }
    /// theta_i, exact at both ends.
    double theta(std::int64_t i) const;
    /// The point at theta, on a circle of `rho` instead of the radius.
    Point at(double theta, double rho) const;
    Point at(double theta) const { return at(theta, radius); }
    /// d(x, y)/d theta at theta [mm/rad].
    Point slope(double theta) const;
    /// Chord slope of step i = 1..n: the ratios k_i of eq. (7) [mm/rad].
    Point chord_ratio(std::int64_t i) const;
    /// Height of a step's arc over its chord [mm]: R (1 - cos(dtheta / 2)).
    double sagitta() const;
};

}  // namespace lineshaft

#pragma once

#include <cstdint>

#include "blocks/axis/axis_motion.hpp"
#include "blocks/profile/cam.hpp"

namespace lineshaft {

/// What the values of a table over time are.
enum class ProfileOf : std::int64_t { position, velocity, acceleration };

/// A motion that a table gives over time: MC_PositionProfile and so on. The table is not kept here:
/// each look is given it.
struct ProfileMotion {
    Moment start;
    std::int64_t table = -1;  ///< number of the cam_table
    ProfileOf of = ProfileOf::position;
    double time_scale = 1;         ///< time = scale * the table's, > 0
    double scale = 1, offset = 0;  ///< value = scale * the table's + offset
    double start_position = 0;     ///< of velocities and accelerations
    double start_velocity = 0;     ///< of accelerations
    double duration = 0;           ///< [s]

    bool has_ended(std::int64_t now) const { return start.has_passed(duration, now); }

    /// t seconds after the start, up to `duration`.
    MotionState at(double t, const Cam& cam) const;
    /// What is kept from there on: rest at the last position, the last velocity, or the one that
    /// the accelerations have led to.
    MotionState end(const Cam& cam) const;

    /// Between which positions it stays up to its end.
    Range positions(const Cam& cam) const;

    /// Whether velocity, acceleration and jerk stay within limits, also at the points.
    bool keeps(const Dynamics& limits, const Cam& cam) const;
};

}  // namespace lineshaft

#pragma once

#include <cstdint>
#include <optional>

#include "blocks/axis/axis_motion.hpp"

namespace lineshaft {

/// Velocities along the direction of a motion [u/s], from `least` to `greatest`; none where least
/// is above greatest. 0..0: standstill.
struct Speeds {
    double least = 0, greatest = 0;

    bool exist() const { return least <= greatest; }
    bool operator==(const Speeds&) const = default;
};

/// What an axis knows of a command that waits (axis_blending.cpp). It hangs on the commands behind
/// it, and on where the one before ends: another command at the end of the queue changes it for a
/// few only.
///
/// Moves in a row that blend and have the same limits are one stretch: no end between them asks for
/// a velocity of its own, and they are passed with whatever velocity and acceleration the axis then
/// has. The end of a stretch is passed at acceleration 0.
struct Ahead {
    double goal = 0;          ///< where it ends [u]
    double direction = 0;     ///< 1 or -1; 0: it is no move, or one of no length
    std::int64_t passes = 0;  ///< it begins in motion: the one before does not stand at its end
    std::int64_t joins = 0;   ///< and goes on with the stretch of the one before
    double stretch_end = 0;   ///< [u]
    Speeds exit;              ///< there
    Speeds entry;             ///< where it begins, if that is where its stretch begins

    bool operator==(const Ahead&) const = default;
};

/// From which velocities a way can be driven, without turning round, so that it ends with one of
/// `exit`; acceleration 0 at both ends. `way` >= 0 [u], exit.exist().
///
/// A ramp between v and w takes (v + w)/2 T, T the duration of the ramp. It grows with the greater
/// of both; over the lesser it has one greatest value, so of an interval of exits one of its ends
/// asks for the least way; or standstill does, from which it grows again.
Speeds entries(double way, const Speeds& exit, const Dynamics& dynamics);

/// The greatest velocity v >= `to` from which, or to which `to` grows, a ramp takes no more than
/// the way; less by a rounding.
double greatest_change(double to, double way, double acceleration, double jerk);

/// The greatest of `exit` to which a motion on the way, from the state, counted along its
/// direction, does not turn round; empty: none is found.
std::optional<double> greatest_exit(const MotionState& from, double way, const Speeds& exit,
                                    const Dynamics& dynamics);

}  // namespace lineshaft

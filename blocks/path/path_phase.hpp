#pragma once

#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

/// A part of a motion along a path: either its jerk lasts, or, where `slope` is not 0, the
/// acceleration changes evenly with the way,
///
///     a = a0 + slope (s - s0),    jerk = slope v,
///
/// so that v^2/2 is a polynomial of degree two of the way.
struct PathPhase {
    double begin = 0;   ///< since the motion began [s]
    MotionState start;  ///< position from where the motion began [u]; its jerk where slope is 0
    double slope = 0;   ///< [1/s^2]

    /// State t seconds after the phase began; slope t^2 is small.
    MotionState after(double t) const;
};

/// When a way [u] has been run from a state with this jerk, within `duration`, where the velocity
/// is not negative [s].
double time_at_way(const MotionState& from, double duration, double way);

double time_at_way(const PathPhase& phase, double duration, double way);

/// How long a phase with a slope takes over a way > 0 at whose end it has the velocity v [s].
double duration_over(const PathPhase& phase, double way, double v);

}  // namespace lineshaft

#pragma once

#include "blocks/profile/any_state.hpp"
#include "blocks/profile/curve.hpp"
#include "blocks/profile/polynomial.hpp"

namespace lineshaft {

/// From one state to another one in a given time, within limits: the planner's mean of the fastest
/// and the slowest motion (any_state.hpp), in a frame that moves with the middle of the velocities,
/// where those of one sign alone are limits like others. A goal with an acceleration is reached by
/// a piece of constant jerk from a state without.
struct TimedMotion {
    MotionPlan plan;     ///< in the frame
    double drift = 0;    ///< velocity of the frame [u/s]
    MotionState easing;  ///< at the end of the plan: its jerk lasts from there on

    /// State t seconds after the start.
    MotionState at(double t) const;

    /// Velocity in `velocities`, acceleration upwards and downwards and jerk in `limits`. `time` >
    /// 0 [s]. What cannot be kept is told by name; *this is then unchanged. A start or a goal
    /// beyond a limit is no way within them; where time or way do not suffice it is the jerk that
    /// is named.
    CurveFault begin(const MotionState& from, const MotionState& to, double time,
                     const TransitionLimits& limits, const Range& velocities);
};

}  // namespace lineshaft

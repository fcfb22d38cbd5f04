#pragma once

#include <cstdint>
#include <string_view>

#include "blocks/profile/any_state.hpp"

namespace lineshaft {

/// What keeps the way onto a moving guide steady.
enum class TransitionMode : std::int64_t {
    jerk_limited,
    acceleration_limited,  ///< the acceleration changes within a nanosecond
    step,                  ///< the velocity, too: nothing is limited
};

inline constexpr std::string_view transition_mode_names[] = {"jerk_limited", "acceleration_limited",
                                                             "step"};

struct TransitionLimits {
    double velocity = 1;      ///< V > 0 [u/s], looked at when the position is caught up
    double acceleration = 1;  ///< A > 0, upwards [u/s^2]
    double deceleration = 1;  ///< D > 0, downwards [u/s^2]
    double jerk = 1;          ///< J > 0 [u/s^3]
};

/// The way of a slave onto a guide: the motion that it has in gear, as ratio x master, counted from
/// wherever it then is. It is planned relative to the guide g, which is foreseen to keep its jerk:
///
///     w = v - vg,  b = a - ag    to 0, 0 in the least time, and with `caught_up` r = x - xg to a
///     goal
///
/// with b in -(D + ag) .. A - ag and jerk J - |jg|; so it is the optimum onto a guide of constant
/// acceleration, and its end is exact. A jerk of the guide above J/2, or an acceleration above the
/// slave's, cannot be allowed for: then the guide is foreseen with constant acceleration or
/// velocity. A guide that moves otherwise than foreseen has to be planned onto anew, from the state
/// of then: what the slave does is without a jump then, too, and within its limits.
struct Transition {
    MotionState guide;  ///< as foreseen, at the start
    MotionPlan plan;    ///< relative to it

    /// The slave t seconds after the start; from `plan.duration` on it is in gear.
    MotionState at(double t) const;

    /// Whether the slave moves against `direction` on the way.
    bool runs_against(double direction) const;

    /// Whether the guide moves as foreseen, but for rounding.
    bool foresees(const MotionState& guide_now, double t) const;
};

struct TransitionGoal {
    TransitionMode mode = TransitionMode::jerk_limited;
    bool catch_up = false;
    double offset = 0;  ///< of the slave's position from the guide's, where it is caught up [u]
};

/// From the state `slave` onto `guide`. On failure `out` is unchanged: not_finite,
/// limit_not_positive, or velocity_above_limit where the guide is faster than V and is to be caught
/// up.
PlanResult plan(const TransitionLimits& limits, const MotionState& slave, const MotionState& guide,
                const TransitionGoal& goal, Transition& out);

}  // namespace lineshaft

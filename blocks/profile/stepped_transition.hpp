#pragma once

#include <cstdint>
#include <optional>

#include "blocks/profile/transition.hpp"

namespace lineshaft {

/// The way of a slave onto the velocity of a moving guide, by an interpolator that plans in whole
/// steps of its own: within a step of `quantum` seconds the acceleration is constant, and only
/// between two steps is it chosen anew. Of N steps the accelerations lie between two envelopes, a0
/// the slave's at the start, ag the guide's at the end, h = J quantum:
///
///     upper[k] = min(A,  a0 + k h, ag + (N + 1 - k) h)     k = 1 .. N
///     lower[k] = max(-D, a0 - k h, ag - (N + 1 - k) h)
///     a[k]     = lower[k] + c (upper[k] - lower[k])         0 <= c <= 1
///
/// with the c that brings the slave to the guide's velocity as foreseen at the end, and the least N
/// for which there is one. So a velocity change of dv takes ceil(dv / (A quantum)) steps of equal
/// acceleration where h is above A + D, and never less than one: that is not a duration rounded
/// up, as the acceleration falls in the same measure. The steps begin with the job, wherever the
/// motion clock is: an axis shows at its scans how far the step under way has come. That a
/// controller plans so is a finding (programs/paper/wei2025_table1_fit.yaml), no vendor's word.
struct TransitionStep {
    double acceleration = 0;  ///< for the step at hand [u/s^2]
    std::int64_t left = 0;    ///< steps behind it, if the guide goes on as foreseen
};

/// The first of the steps from the state `slave` onto `guide`, which is foreseen to keep its jerk.
/// `expected`: how many a step before has left, 0 at the start; they are kept where they serve.
/// Empty where no number of steps up to `most_transition_steps` does.
std::optional<TransitionStep> first_step(const TransitionLimits& limits, double quantum,
                                         const MotionState& slave, const MotionState& guide,
                                         std::int64_t expected = 0);

inline constexpr std::int64_t most_transition_steps = std::int64_t{1} << 40;

}  // namespace lineshaft

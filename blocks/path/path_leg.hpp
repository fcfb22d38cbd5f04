#pragma once

#include <cstdint>

#include "blocks/path/path_stretch.hpp"
#include "blocks/profile/any_state.hpp"

namespace lineshaft {

/// One motion along the path, within the boxes of all stretches that it passes, to the end of one
/// of them, where the acceleration is 0; or, of a halt, to standstill anywhere.
struct PathLeg {
    MotionPlan plan;         ///< from `base` on
    double base = 0;         ///< where it begins along the path [u]
    double end = 0;          ///< ... and ends [u]
    double ripe = 0;         ///< until then [s] what comes behind cannot make it any faster
    std::uint64_t goal = 0;  ///< the stretch in which it ends
};

/// The next leg from a state (its position is 0) at `base` within the first of the stretches, with
/// `factor` 0..1 of the velocities; 0 is a halt, with acceleration and jerk of `halt` where there
/// is room for that. False, and `out` is unchanged, where there is none: then what was planned goes
/// on.
bool plan_leg(ConstPathStretches stretches, const MotionState& from, double base, double factor,
              const PathLimit& halt, PathLeg& out);

/// The way that a direct ramp takes from a state to a velocity; infinite where there is none [u].
double way_to(const MotionState& from, double velocity, const PathLimit& box);

}  // namespace lineshaft

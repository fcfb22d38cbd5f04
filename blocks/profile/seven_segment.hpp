#pragma once

#include <array>

#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

/// Jerk-limited move along a path from Vs to Ve, acceleration zero at both ends (Liu 2023).
struct SevenSegment {
    double Vs = 0, Ve = 0;  ///< start and end velocity [u/s], 0 <= Vs, Ve <= Vm
    double Vm = 1;          ///< velocity limit [u/s], > 0
    double A = 1;           ///< acceleration limit, both ways [u/s^2], > 0
    double J = 1;           ///< jerk limit [u/s^3], > 0
    double L = 0;           ///< path length [u], >= 0
};

struct SevenSegmentPlan {
    std::array<double, 7> T{};         ///< durations of the segments, jerk +J 0 -J 0 -J 0 +J [s]
    std::array<MotionState, 7> start;  ///< state at the start of each segment
    double duration = 0;               ///< [s]
    MotionState end;                   ///< end.position is exactly L

    MotionState at(double t) const;  ///< clamped to 0..duration
};

PlanResult plan(const SevenSegment& problem, SevenSegmentPlan& out);

}  // namespace lineshaft

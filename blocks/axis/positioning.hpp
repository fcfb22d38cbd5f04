#pragma once

#include <cstdint>

#include "blocks/profile/seven_segment.hpp"

namespace lineshaft {

/// An absolute move in virtual time. After its end the velocity that it has there stays.
struct Positioning {
    SevenSegmentPlan plan;
    double start_position = 0;  ///< [u]
    double target = 0;          ///< [u], reached exactly
    double direction = 1;       ///< -1 towards lesser positions
    std::int64_t start_time = 0;

    /// From standstill at `position` to standstill at `goal` [u] under the limits [u/s], [u/s^2],
    /// [u/s^3].
    PlanResult begin(double position, double goal, double velocity, double acceleration,
                     double jerk, std::int64_t time);

    /// From the position and velocity of `from`, whose acceleration is 0, to `goal`. Of `problem`
    /// Ve, Vm, A, J count. A velocity away from the goal is refused as velocity_above_limit.
    PlanResult begin(const MotionState& from, double goal, SevenSegment problem, std::int64_t time);

    bool finished(std::int64_t time) const;
    MotionState at(std::int64_t time) const;
};

}  // namespace lineshaft

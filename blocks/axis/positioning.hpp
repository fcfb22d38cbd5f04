#pragma once

#include <cstdint>

#include "blocks/profile/seven_segment.hpp"

namespace lineshaft {

/// An absolute move from standstill to standstill in virtual time.
struct Positioning {
    SevenSegmentPlan plan;
    double start_position = 0;  ///< [u]
    double target = 0;          ///< [u], reached exactly
    std::int64_t start_time = 0;

    /// From `position` to `goal` [u] under the limits [u/s], [u/s^2], [u/s^3].
    PlanResult begin(double position, double goal, double velocity, double acceleration,
                     double jerk, std::int64_t time);

    bool finished(std::int64_t time) const;
    MotionState at(std::int64_t time) const;
};

}  // namespace lineshaft

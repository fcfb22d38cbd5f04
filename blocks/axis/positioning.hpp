#pragma once

#include <cstdint>

#include "blocks/profile/any_state.hpp"
#include "blocks/profile/seven_segment.hpp"

namespace lineshaft {

/// An absolute move in virtual time. After its end the velocity that it has there stays.
struct Positioning {
    SevenSegmentPlan plan;
    MotionPlan motion;  ///< in place of `plan` if `from_any_state`
    bool from_any_state = false;
    double start_position = 0;  ///< [u]
    double target = 0;          ///< [u], reached exactly
    double direction = 1;       ///< -1 towards lesser positions
    std::int64_t start_time = 0;

    /// From standstill at `position` to standstill at `goal` [u] under the limits [u/s], [u/s^2],
    /// [u/s^3].
    PlanResult begin(double position, double goal, double velocity, double acceleration,
                     double jerk, std::int64_t time);

    /// From the state `from` to `goal`. Of `problem` Ve, Vm, A, J count; Ve in the direction of the
    /// goal. In seven segments at constant velocity towards the goal, within Vm; in the least time
    /// from any other state, which always reaches Ve.
    PlanResult begin(const MotionState& from, double goal, SevenSegment problem, std::int64_t time);

    double duration() const { return from_any_state ? motion.duration : plan.duration; }  ///< [s]
    bool reaches_Ve() const { return from_any_state || plan.reaches_Ve; }
    bool finished(std::int64_t time) const;
    MotionState at(std::int64_t time) const;
    void shift(std::int64_t by) { start_time += by; }

  private:
    PlanResult begin_from_any_state(const MotionState& from, double goal,
                                    const SevenSegment& problem, bool back);
};

}  // namespace lineshaft

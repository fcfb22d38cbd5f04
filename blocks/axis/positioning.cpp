#include "blocks/axis/positioning.hpp"

#include <cmath>

#include "runtime/model/scan.hpp"

namespace lineshaft {

PlanResult Positioning::begin(double position, double goal, double velocity, double acceleration,
                              double jerk, std::int64_t time) {
    const PlanResult result = lineshaft::plan({.Vs = 0,
                                               .Ve = 0,
                                               .Vm = velocity,
                                               .A = acceleration,
                                               .J = jerk,
                                               .L = std::abs(goal - position)},
                                              plan);
    if (result != PlanResult::ok) return result;
    start_position = position;
    target = goal;
    start_time = time;
    return result;
}

bool Positioning::finished(std::int64_t time) const {
    return seconds(time - start_time) >= plan.duration;
}

MotionState Positioning::at(std::int64_t time) const {
    if (finished(time)) return {.position = target};
    const double sign = target < start_position ? -1 : 1;
    const MotionState s = plan.at(seconds(time - start_time));
    return {.position = start_position + sign * s.position,
            .velocity = sign * s.velocity,
            .acceleration = sign * s.acceleration,
            .jerk = sign * s.jerk};
}

}  // namespace lineshaft

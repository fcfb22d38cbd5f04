#include "blocks/axis/positioning.hpp"

#include <cmath>

#include "runtime/model/scan.hpp"

namespace lineshaft {

PlanResult Positioning::begin(double position, double goal, double velocity, double acceleration,
                              double jerk, std::int64_t time) {
    return begin({.position = position}, goal, {.Vm = velocity, .A = acceleration, .J = jerk},
                 time);
}

PlanResult Positioning::begin(const MotionState& from, double goal, SevenSegment problem,
                              std::int64_t time) {
    const bool back = goal < from.position || (goal == from.position && from.velocity < 0);
    problem.Vs = back ? -from.velocity : from.velocity;
    problem.L = std::abs(goal - from.position);
    const bool any = from.acceleration != 0 || problem.Vs < 0 || problem.Vs > problem.Vm;
    const PlanResult result =
        any ? begin_from_any_state(from, goal, problem, back) : lineshaft::plan(problem, plan);
    if (result != PlanResult::ok) return result;
    from_any_state = any;
    start_position = from.position;
    target = goal;
    direction = back ? -1 : 1;
    start_time = time;
    return result;
}

PlanResult Positioning::begin_from_any_state(const MotionState& from, double goal,
                                             const SevenSegment& problem, bool back) {
    if (problem.Ve < 0) return PlanResult::velocity_above_limit;
    MotionLimits limits;
    const PlanResult result = limits.set(problem.Vm, -problem.Vm, problem.A, problem.A, problem.J);
    if (result != PlanResult::ok) return result;
    return lineshaft::plan(limits, from, {goal, back ? -problem.Ve : problem.Ve}, motion);
}

bool Positioning::finished(std::int64_t time) const {
    return seconds(time - start_time) >= duration();
}

MotionState Positioning::at(std::int64_t time) const {
    const double t = seconds(time - start_time);
    if (from_any_state) return motion.at(t);
    if (finished(time)) {
        if (plan.end.velocity == 0) return {.position = target};
        const double velocity = direction * plan.end.velocity;
        return {.position = target + velocity * (t - plan.duration), .velocity = velocity};
    }
    const MotionState s = plan.at(t);
    return {.position = start_position + direction * s.position,
            .velocity = direction * s.velocity,
            .acceleration = direction * s.acceleration,
            .jerk = direction * s.jerk};
}

}  // namespace lineshaft

#include "blocks/profile/timed_motion.hpp"

#include <cmath>

namespace lineshaft {

namespace {

/// A limit is kept where rounding alone is beyond it.
constexpr double slight = 1e-9;
/// A controller plans anew from what it has rounded itself.
constexpr PlanOptions again_and_again{Entry::gentle, 1024};

CurveFault fault_within(const MotionState& s, const TransitionLimits& limits,
                        const Range& velocities) {
    const double v = slight * velocities.size();
    if (!(s.velocity >= velocities.least - v && s.velocity <= velocities.greatest + v))
        return CurveFault::velocity;
    constexpr double more = 1 + slight;
    const bool held = s.acceleration <= limits.acceleration * more &&
                      s.acceleration >= -limits.deceleration * more;
    return held ? CurveFault::none : CurveFault::acceleration;
}

/// Coming back from its start, a motion may be beyond in between.
bool keeps(const MotionPlan& plan, const TransitionLimits& limits, const Range& velocities) {
    for (std::size_t i = 0; i < plan.count; ++i) {
        const auto& [begin, duration, s] = plan.phases[i];
        const Range v =
            range(Polynomial<2>{{s.velocity, s.acceleration, 0.5 * s.jerk}}, 0, duration);
        for (const double velocity : {v.least, v.greatest})
            if (fault_within({0, velocity, s.acceleration, 0}, limits, velocities) !=
                CurveFault::none)
                return false;
    }
    return true;
}

}  // namespace

MotionState TimedMotion::at(double t) const {
    if (t > plan.duration) return easing.after(t - plan.duration);
    MotionState s = plan.at(t);
    s.position += drift * t;
    s.velocity += drift;
    return s;
}

CurveFault TimedMotion::begin(const MotionState& from, const MotionState& to, double time,
                              const TransitionLimits& limits, const Range& velocities) {
    for (const MotionState& s : {from, to})
        if (const CurveFault fault = fault_within(s, limits, velocities); fault != CurveFault::none)
            return fault;
    const double middle = 0.5 * (velocities.least + velocities.greatest);
    const double half = 0.5 * (velocities.greatest - velocities.least);
    MotionLimits around;
    if (around.set(half, -half, limits.acceleration, limits.deceleration, limits.jerk) !=
        PlanResult::ok)
        return CurveFault::velocity;
    const MotionState start{from.position, from.velocity - middle, from.acceleration, 0};
    const bool eased = to.acceleration * to.jerk > 0;
    const double own = eased ? std::min(std::abs(to.jerk), limits.jerk) : limits.jerk;
    for (const double size : {limits.jerk, own}) {
        const double jerk = std::copysign(size, to.acceleration);
        const double ease = to.acceleration / jerk, left = time - ease;
        if (left < 0) continue;
        MotionState last =
            MotionState{to.position, to.velocity, to.acceleration, jerk}.after(-ease);
        last.acceleration = 0;
        if (ease == 0) last.jerk = 0;
        MotionPlan tried;
        const Goal goal{last.position - middle * left, last.velocity - middle};
        if (lineshaft::plan(around, start, goal, left, tried, again_and_again) != PlanResult::ok)
            continue;
        if (tried.duration > left + slight * slight + 0x1p-40 * time) continue;
        if (!keeps(tried, limits, {-half, half})) continue;
        plan = tried;
        drift = middle;
        easing = last;
        return CurveFault::none;
    }
    return CurveFault::jerk;
}

}  // namespace lineshaft

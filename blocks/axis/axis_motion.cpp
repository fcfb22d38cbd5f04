#include "blocks/axis/axis_motion.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

namespace {

/// Whether a phase of constant jerk goes against `direction` for more than a rounding.
bool runs_against(const MotionState& start, double duration, double direction, double slack) {
    const auto against = [&](double velocity) { return velocity * direction < -slack; };
    if (against(start.velocity) || against(start.after(duration).velocity)) return true;
    const double turn = start.jerk != 0 ? -start.acceleration / start.jerk : 0;
    return turn > 0 && turn < duration && against(start.after(turn).velocity);
}

template <class Phases>
bool runs_against(const Phases& phases, std::size_t count, double direction, double slack) {
    for (std::size_t i = 0; i < count; ++i)
        if (runs_against(phases[i].start, phases[i].duration, direction, slack)) return true;
    return false;
}

template <class Phases>
double greatest_jerk_of(const Phases& phases, std::size_t count) {
    double greatest = 0;
    for (std::size_t i = 0; i < count; ++i)
        greatest = std::max(greatest, std::abs(phases[i].start.jerk));
    return greatest;
}

constexpr double rounding = 1e-12;  ///< of a velocity

/// Limits along the direction of the motion.
PlanResult limits_along(double direction, double velocity, const Dynamics& d, MotionLimits& to) {
    const bool forward = direction >= 0;
    return to.set(velocity, -velocity, forward ? d.acceleration : d.deceleration,
                  forward ? d.deceleration : d.acceleration, d.jerk);
}

}  // namespace

Dynamics symmetric(Dynamics d) {
    d.acceleration = d.deceleration = std::min(d.acceleration, d.deceleration);
    return d;
}

Moment Moment::after(double duration) const {
    const double sum = later + duration;
    const double whole = std::floor(sum * 1e9);
    return {time + static_cast<std::int64_t>(whole), std::max(0.0, sum - whole / 1e9)};
}

bool Dynamics::valid() const {
    const auto good = [](double x) { return x > 0 && std::isfinite(x); };
    return good(velocity) && good(acceleration) && good(deceleration) && good(jerk);
}

double effective_jerk(double jerk, double acceleration, double deceleration) {
    constexpr double per_nanosecond = 1e9;
    return jerk == 0 ? per_nanosecond * std::max(acceleration, deceleration) : jerk;
}

Dynamics without_turning(Dynamics d, const MotionState& from, double most) {
    const double v = from.velocity, a = from.acceleration;
    if (v * a < 0) d.jerk = std::max(d.jerk, std::min(a * a / (2 * std::abs(v)), most));
    return d;
}

PlanResult PointMotion::begin(const MotionState& from, double goal, double end_velocity,
                              const Dynamics& dynamics, const Moment& at) {
    const double velocity = std::max(dynamics.velocity, std::abs(end_velocity));
    const double way = goal - from.position;
    const double direction = way != 0 ? way : end_velocity;
    MotionLimits limits;
    PlanResult result = limits_along(direction, velocity, dynamics, limits);
    if (result != PlanResult::ok) return result;
    result = lineshaft::plan(limits, from, {goal, end_velocity}, plan);
    if (result != PlanResult::ok) return result;
    const bool uneven = dynamics.acceleration != dynamics.deceleration;
    if (uneven && runs_against(plan.phases, plan.count, direction, rounding * velocity)) {
        limits_along(direction, velocity, symmetric(dynamics), limits);
        lineshaft::plan(limits, from, {goal, end_velocity}, plan);
    }
    start = at;
    duration = plan.duration;
    end_state = plan.end;
    phase = 0;
    return result;
}

void PointMotion::end_at(double position, double direction) {
    duration = plan.duration;
    end_state = plan.end;
    if (!((plan.end.position - position) * direction > 0)) return;
    const auto is_before = [&](double t) {
        return (plan.at(t).position - position) * direction < 0;
    };
    double low = 0, high = plan.duration;
    for (int i = 0; i < 64; ++i) {
        const double middle = 0.5 * (low + high);
        (is_before(middle) ? low : high) = middle;
    }
    duration = high;
    end_state = plan.at(high);
    end_state.position = position;
}

bool PointMotion::turns(double direction) const {
    return runs_against(plan.phases, plan.count, direction, rounding * plan.greatest_velocity());
}

double PointMotion::greatest_jerk() const {
    return greatest_jerk_of(plan.phases, plan.count);
}

void PointMotion::move(double by) {
    for (std::size_t i = 0; i < plan.count; ++i) plan.phases[i].start.position += by;
    plan.end.position += by;
}

PlanResult VelocityMotion::begin(const MotionState& from, double velocity, const Dynamics& dynamics,
                                 const Moment& at) {
    const double direction = velocity != 0 ? velocity : from.velocity;
    const auto plan_with = [&](const Dynamics& d) {
        const bool forward = direction >= 0;
        return ramp.plan(from.velocity, from.acceleration, velocity,
                         forward ? d.acceleration : d.deceleration,
                         forward ? d.deceleration : d.acceleration, d.jerk);
    };
    PlanResult result = plan_with(dynamics);
    if (result != PlanResult::ok) return result;
    const double slack = rounding * std::max(std::abs(from.velocity), std::abs(velocity));
    if (dynamics.acceleration != dynamics.deceleration &&
        runs_against(ramp.phases, static_cast<std::size_t>(ramp.count), direction, slack))
        result = plan_with(symmetric(dynamics));
    start = at;
    start_position = from.position;
    return result;
}

void VelocityMotion::hold(const MotionState& state, const Moment& at) {
    start = at;
    start_position = state.position;
    ramp.count = 0;
    ramp.duration = 0;
    ramp.end = {0, state.velocity, 0, 0};
}

bool VelocityMotion::stand_at(double position, const MotionState& from, const Moment& at) {
    const double way = position - from.position;
    const double time = 2 * way / from.velocity, deceleration = from.velocity / time;
    if (!(time > 0) || !std::isfinite(time) || !std::isfinite(deceleration)) return false;
    start = at;
    start_position = from.position;
    ramp.phases[0] = {time, {0, from.velocity, -deceleration, 0}};
    ramp.count = 1;
    ramp.duration = time;
    ramp.end = {way, 0, 0, 0};
    return true;
}

MotionState VelocityMotion::later(double t) const {
    MotionState state = before_start(ramp.at(t), t);
    state.position += start_position;
    return state;
}

MotionState VelocityMotion::end_state() const {
    MotionState state = ramp.end;
    state.position += start_position;
    return state;
}

double VelocityMotion::greatest_jerk() const {
    return greatest_jerk_of(ramp.phases, static_cast<std::size_t>(ramp.count));
}

double ramp_way(double from, double to, const Dynamics& dynamics) {
    VelocityMotion motion;
    motion.begin({.velocity = from}, to, dynamics, {});
    return motion.end_state().position;
}

double stopping_position(const MotionState& from, const Dynamics& dynamics) {
    VelocityMotion motion;
    if (motion.begin(from, 0, dynamics, {}) != PlanResult::ok) return from.position;
    return motion.end_state().position;
}

}  // namespace lineshaft

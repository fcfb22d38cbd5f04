#include "blocks/axis/gear_axis.hpp"

namespace lineshaft {

namespace {

/// Virtual time counts whole nanoseconds: a ramp that ends within one has ended.
constexpr double one_nanosecond = 1e-9;

}  // namespace

std::span<const Field> GearAxis::fields() {
    using A = GearAxis;
    static const Field table[] = {
        parameter("unit", &A::unit, "", "unit of the slave").one_of(axis_unit_names),
        parameter("master_unit", &A::master_unit, "", "unit of the master").one_of(axis_unit_names),
        parameter("start_position", &A::start_position, "{unit}", "position at the first scan"),
        input("master_position", &A::master_position, "{master_unit}", "set-point of the master")
            .must_be_set(),
        input("master_velocity", &A::master_velocity, "{master_unit}/s", "velocity of the master")
            .must_be_set(),
        input("master_acceleration", &A::master_acceleration, "{master_unit}/s^2",
              "acceleration of the master; 0 if it is not known"),
        input("ratio", &A::ratio, "{unit}/{master_unit}",
              "slave velocity / master velocity; each change is a new job"),
        input("acceleration", &A::acceleration_limit, "{unit}/s^2", "limit, taken with each job")
            .above(0),
        input("jerk", &A::jerk_limit, "{unit}/s^3", "limit, taken with each job").above(0),
        input("home", &A::home, "", "rising edge: set the position"),
        input("home_position", &A::home_position, "{unit}", "position set by `home`"),
        input("move", &A::move, "", "rising edge: move to `target`, at ratio 0 only"),
        input("target", &A::target, "{unit}", "end of the move"),
        input("move_velocity", &A::move_velocity, "{unit}/s", "greatest velocity of the move")
            .above(0),
        output("position", &A::position, "{unit}", "set-point"),
        output("velocity", &A::velocity, "{unit}/s", "of the set-point"),
        output("acceleration", &A::acceleration, "{unit}/s^2", "of the set-point"),
        output("in_gear", &A::in_gear, "", "synchronous: velocity = ratio * master velocity"),
        output("moving", &A::moving, "", "positioning by `move` is under way"),
        output("error", &A::error, "", "an input cannot be followed; outputs are held"),
        output("error_id", &A::error_id, "", "why").one_of(axis_error_names),
    };
    return table;
}

void GearAxis::scan(const Scan& now) {
    error_id = check();
    if (error_id == AxisError::none) {
        error_id = advance(now.time);
        const AxisError refused = command(now.time);
        if (error_id == AxisError::none) error_id = refused;
        in_gear = phase == Phase::synchronous;
        moving = phase == Phase::positioning;
    }
    error = error_id != AxisError::none;
}

AxisError GearAxis::command(std::int64_t time) {
    if (rising_edge(home, last_home) && phase == Phase::synchronous) {
        anchor(home_position, master_position);
        position = home_position;
    }
    AxisError result = AxisError::none;
    if (phase != Phase::positioning && ratio != job.ratio) result = begin_job(time);
    if (rising_edge(move, last_move)) result = begin_positioning(time);
    return result;
}

AxisError GearAxis::check() const {
    if (!all_finite(master_position, master_velocity, master_acceleration, ratio,
                    acceleration_limit, jerk_limit, home_position, target, move_velocity))
        return AxisError::not_finite;
    return acceleration_limit > 0 && jerk_limit > 0 && move_velocity > 0
               ? AxisError::none
               : AxisError::limit_not_positive;
}

AxisError GearAxis::advance(std::int64_t time) {
    if (first_scan) {
        first_scan = false;
        position = start_position;
        anchor(start_position, master_position);
        return AxisError::none;
    }
    if (phase == Phase::positioning) {
        const MotionState s = positioning.at(time);
        if (positioning.finished(time)) anchor(positioning.target, master_position);
        return set(s);
    }
    if (phase == Phase::transition) {
        const double t = seconds(time - ramp_start);
        if (t + one_nanosecond < ramp.duration) return ride_ramp(time, t);
        const double master_then = master_position - master_velocity * (t - ramp.duration);
        if (!std::isfinite(master_then)) return AxisError::not_finite;
        anchor(ramp_position + ramp.end.position, master_then);
    }
    return set({anchor_position + job.ratio * (master_position - anchor_master),
                job.ratio * master_velocity, job.ratio * master_acceleration + 0.0, 0});
}

AxisError GearAxis::ride_ramp(std::int64_t time, double t) {
    MotionState s = ramp.at(t);
    s.position += ramp_position;
    const AxisError result = set(s);
    if (result != AxisError::none || job.ratio * master_velocity == ramp_goal) return result;
    return begin_transition(time);
}

AxisError GearAxis::begin_job(std::int64_t time) {
    const Job last = job;
    job = {ratio, acceleration_limit, jerk_limit};
    const AxisError result = begin_transition(time);
    if (result != AxisError::none) job = last;
    return result;
}

/// From the state set by advance() to the job's ratio.
AxisError GearAxis::begin_transition(std::int64_t time) {
    const double goal = job.ratio * master_velocity;
    if (velocity == goal && acceleration == 0) {
        anchor(position, master_position);
        return AxisError::none;
    }
    const PlanResult result = ramp.plan(velocity, acceleration, goal, job.acceleration, job.jerk);
    if (result != PlanResult::ok) return axis_error(result);
    ramp_start = time;
    ramp_position = position;
    ramp_goal = goal;
    phase = Phase::transition;
    return AxisError::none;
}

AxisError GearAxis::begin_positioning(std::int64_t time) {
    if (job.ratio != 0 || velocity != 0) return AxisError::not_standing;
    const PlanResult result =
        positioning.begin(position, target, move_velocity, acceleration_limit, jerk_limit, time);
    if (result == PlanResult::ok) phase = Phase::positioning;
    return axis_error(result);
}

void GearAxis::anchor(double at_position, double at_master) {
    phase = Phase::synchronous;
    anchor_position = at_position;
    anchor_master = at_master;
}

/// What no double can hold is not set.
AxisError GearAxis::set(const MotionState& state) {
    if (!all_finite(state.position, state.velocity, state.acceleration))
        return AxisError::not_finite;
    position = state.position;
    velocity = state.velocity;
    acceleration = state.acceleration;
    return AxisError::none;
}

}  // namespace lineshaft

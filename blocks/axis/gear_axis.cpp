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
        output("in_gear", &A::in_gear, "", "velocity = ratio * master velocity"),
        output("moving", &A::moving, "", "positioning by `move` is under way"),
        output("error", &A::error, "", "an input cannot be followed; outputs are held"),
        output("error_id", &A::error_id, "", "why").one_of(axis_error_names),
    };
    return table;
}

void GearAxis::scan(const Scan& now) {
    error_id = check();
    error = error_id != AxisError::none;
    if (error) return;
    if (first_scan) {
        first_scan = false;
        position = start_position;
        job_ratio = ratio;
        anchor(start_position, master_position);
    }
    advance(now.time);
    if (rising_edge(home, last_home) && phase == Phase::synchronous)
        anchor(home_position, master_position);
    if (rising_edge(move, last_move))
        error_id = begin_positioning(now.time);
    else if (phase != Phase::positioning && ratio != job_ratio) {
        job_ratio = ratio;
        job_acceleration = acceleration_limit;
        job_jerk = jerk_limit;
        error_id = begin_transition(now.time);
    }
    error = error_id != AxisError::none;
    in_gear = phase == Phase::synchronous;
    moving = phase == Phase::positioning;
}

AxisError GearAxis::check() const {
    if (!all_finite(master_position, master_velocity, ratio, acceleration_limit, jerk_limit,
                    home_position, target, move_velocity))
        return AxisError::not_finite;
    return acceleration_limit > 0 && jerk_limit > 0 && move_velocity > 0
               ? AxisError::none
               : AxisError::limit_not_positive;
}

void GearAxis::advance(std::int64_t time) {
    if (phase == Phase::positioning) {
        set(positioning.at(time));
        if (positioning.finished(time)) anchor(positioning.target, master_position);
        return;
    }
    if (phase == Phase::transition) {
        const double t = seconds(time - ramp_start);
        MotionState s = ramp.at(t);
        s.position += ramp_position;
        set(s);
        if (t + one_nanosecond >= ramp.duration)
            anchor(ramp_position + ramp.end.position,
                   master_position - master_velocity * (t - ramp.duration));
        else if (job_ratio * master_velocity != ramp_goal)
            error_id = begin_transition(time);
    }
    if (phase == Phase::synchronous)
        set({anchor_position + job_ratio * (master_position - anchor_master),
             job_ratio * master_velocity, 0, 0});
}

/// From the state set by advance() to the job's ratio.
AxisError GearAxis::begin_transition(std::int64_t time) {
    ramp_goal = job_ratio * master_velocity;
    if (velocity == ramp_goal && acceleration == 0) {
        anchor(position, master_position);
        return AxisError::none;
    }
    const PlanResult result =
        ramp.plan(velocity, acceleration, ramp_goal, job_acceleration, job_jerk);
    if (result != PlanResult::ok) return axis_error(result);
    ramp_start = time;
    ramp_position = position;
    phase = Phase::transition;
    return AxisError::none;
}

AxisError GearAxis::begin_positioning(std::int64_t time) {
    if (ratio != 0 || job_ratio != 0 || velocity != 0) return AxisError::not_standing;
    const PlanResult result =
        positioning.begin(position, target, move_velocity, acceleration_limit, jerk_limit, time);
    if (result == PlanResult::ok) phase = Phase::positioning;
    return axis_error(result);
}

void GearAxis::anchor(double at_position, double at_master) {
    phase = Phase::synchronous;
    anchor_position = at_position;
    anchor_master = at_master;
    if (job_ratio == 0) set({at_position, 0, 0, 0});
}

void GearAxis::set(const MotionState& state) {
    position = state.position;
    velocity = state.velocity;
    acceleration = state.acceleration;
}

}  // namespace lineshaft

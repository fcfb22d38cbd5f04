#include "blocks/axis/virtual_axis.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view motion_names[] = {"velocity", "absolute"};

}  // namespace

std::span<const Field> VirtualAxis::fields() {
    using A = VirtualAxis;
    static const Field table[] = {
        parameter("unit", &A::unit, "", "unit of the axis").one_of(axis_unit_names),
        parameter("motion", &A::motion, "", "follow `velocity`, or move to `target`")
            .one_of(motion_names),
        parameter("immediate", &A::immediate, "", "velocity changes take no time"),
        parameter("start_position", &A::start_position, "{unit}", "position at the first scan"),
        input("enable", &A::enable, "", "false: ramp to standstill, and no move begins"),
        input("velocity", &A::wanted_velocity, "{unit}/s",
              "velocity to hold; of an absolute move its greatest, above 0")
            .must_be_set(),
        input("acceleration", &A::acceleration_limit, "{unit}/s^2",
              "limit, both ways; taken when a ramp or a move begins")
            .above(0),
        input("jerk", &A::jerk_limit, "{unit}/s^3",
              "limit, both ways; taken when a ramp or a move begins")
            .above(0),
        input("execute", &A::execute, "", "rising edge: move to `target`"),
        input("target", &A::target, "{unit}", "end of an absolute move"),
        input("home", &A::home, "", "rising edge: set the position"),
        input("home_position", &A::home_position, "{unit}", "position set by `home`"),
        output("position", &A::position, "{unit}", "set-point"),
        output("velocity", &A::velocity, "{unit}/s", "of the set-point"),
        output("acceleration", &A::acceleration, "{unit}/s^2", "of the set-point"),
        output("moving", &A::moving, "", "velocity or acceleration is not 0"),
        output("done", &A::done, "", "the absolute move has reached its target"),
        output("error", &A::error, "", "an input cannot be followed; outputs are held"),
        output("error_id", &A::error_id, "", "why").one_of(axis_error_names),
    };
    return table;
}

void VirtualAxis::scan(const Scan& now) {
    if (first_scan) {
        first_scan = false;
        begin_constant(now.time, start_position, 0);
    }
    error_id = check();
    if (error_id == AxisError::none) {
        advance(now.time);
        error_id = command(now.time);
        const AxisError reached = advance(now.time);
        if (error_id == AxisError::none) error_id = reached;
    }
    error = error_id != AxisError::none;
}

AxisError VirtualAxis::command(std::int64_t time) {
    if (rising_edge(home, last_home) && !moving) begin_constant(time, home_position, 0);
    const bool edge = rising_edge(execute, last_execute);
    if (motion == Motion::velocity) return follow_velocity(time, enable ? wanted_velocity : 0);
    if (enable) return edge ? begin_move(time) : AxisError::none;
    const AxisError result = follow_velocity(time, 0);
    return edge && result == AxisError::none ? AxisError::not_enabled : result;
}

AxisError VirtualAxis::check() const {
    if (!all_finite(wanted_velocity, acceleration_limit, jerk_limit, target, home_position))
        return AxisError::not_finite;
    const bool velocity_good = motion == Motion::velocity || wanted_velocity > 0 || !execute;
    return acceleration_limit > 0 && jerk_limit > 0 && velocity_good
               ? AxisError::none
               : AxisError::limit_not_positive;
}

AxisError VirtualAxis::advance(std::int64_t time) {
    const double t = seconds(time - phase_start);
    switch (phase) {
        case Phase::ramp: {
            MotionState s = ramp.at(t);
            s.position += phase_position;
            return set(s);
        }
        case Phase::positioning:
            if (!move.finished(time)) return set(move.at(time));
            return end_move(time);
        case Phase::immediate_move: {
            const double way = move.target - phase_position;
            if (!(phase_velocity * t / way < 1)) return end_move(time);
            break;
        }
        case Phase::constant:
            break;
    }
    return set({phase_position + phase_velocity * t, phase_velocity, 0, 0});
}

void VirtualAxis::begin_constant(std::int64_t time, double from, double at_velocity) {
    phase = Phase::constant;
    phase_start = time;
    phase_position = from;
    phase_velocity = at_velocity;
    set({from, at_velocity, 0, 0});
}

AxisError VirtualAxis::follow_velocity(std::int64_t time, double goal) {
    const double held = phase == Phase::ramp ? ramp_goal : phase_velocity;
    const bool holds = phase == Phase::constant || phase == Phase::ramp;
    if (holds && held == goal) return AxisError::none;
    if (immediate) {
        begin_constant(time, position, goal);
        return AxisError::none;
    }
    const PlanResult result =
        ramp.plan(velocity, acceleration, goal, acceleration_limit, jerk_limit);
    if (result != PlanResult::ok) return axis_error(result);
    phase = Phase::ramp;
    phase_start = time;
    phase_position = position;
    ramp_goal = goal;
    return AxisError::none;
}

AxisError VirtualAxis::begin_move(std::int64_t time) {
    if (!immediate) {
        const PlanResult result =
            move.begin({position, velocity, acceleration, 0}, target,
                       {.Vm = wanted_velocity, .A = acceleration_limit, .J = jerk_limit}, time);
        if (result != PlanResult::ok) return axis_error(result);
        phase = Phase::positioning;
    } else {
        move.target = target;
        phase = Phase::immediate_move;
        phase_start = time;
        phase_position = position;
        phase_velocity = target < position ? -wanted_velocity : wanted_velocity;
    }
    done = false;
    return AxisError::none;
}

AxisError VirtualAxis::end_move(std::int64_t time) {
    begin_constant(time, move.target, 0);
    done = true;
    return AxisError::none;
}

/// What no double can hold is not set.
AxisError VirtualAxis::set(const MotionState& state) {
    if (!all_finite(state.position, state.velocity)) return AxisError::not_finite;
    position = state.position;
    velocity = state.velocity;
    acceleration = state.acceleration;
    moving = state.velocity != 0 || state.acceleration != 0;
    return AxisError::none;
}

}  // namespace lineshaft

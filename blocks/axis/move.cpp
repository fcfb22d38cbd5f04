#include "blocks/axis/move.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

namespace {

constexpr std::string_view error_names[] = {"none", "not_finite", "limit_not_positive",
                                            "velocity_above_limit"};

/// A distance has no sign: there is no negative length.
MoveError move_error(PlanResult result) {
    switch (result) {
        case PlanResult::ok:
            return MoveError::none;
        case PlanResult::limit_not_positive:
            return MoveError::limit_not_positive;
        case PlanResult::velocity_above_limit:
            return MoveError::velocity_above_limit;
        default:
            return MoveError::not_finite;
    }
}

}  // namespace

std::span<const Field> Move::fields() {
    using M = Move;
    static const Field table[] = {
        parameter("unit", &M::unit, "", "unit of the axis").one_of(axis_unit_names),
        parameter("start_position", &M::start_position, "{unit}", "position at the first scan"),
        parameter("start_velocity", &M::start_velocity, "{unit}/s", "until the first move"),
        input("execute", &M::execute, "", "rising edge: move to `position`").must_be_set(),
        input("position", &M::target, "{unit}", "end of the move").must_be_set(),
        input("velocity", &M::velocity_limit, "{unit}/s", "limit").above(0).must_be_set(),
        input("acceleration", &M::acceleration_limit, "{unit}/s^2", "limit, both ways").above(0),
        input("jerk", &M::jerk_limit, "{unit}/s^3", "limit, both ways").above(0),
        input("end_velocity", &M::end_velocity, "{unit}/s", "at `position`, kept from there on")
            .at_least(0),
        output("position", &M::position, "{unit}", "set-point"),
        output("velocity", &M::velocity, "{unit}/s", "of the set-point"),
        output("acceleration", &M::acceleration, "{unit}/s^2", "of the set-point"),
        output("jerk", &M::jerk, "{unit}/s^3", "of the set-point"),
        output("done", &M::done, "", "the move has ended; until `execute` falls"),
        output("busy", &M::busy, "", "the move is under way"),
        output("in_end_velocity", &M::in_end_velocity, "", "the move has ended at `end_velocity`"),
        output("error", &M::error, "", "an input cannot be followed, or a move is refused"),
        output("error_id", &M::error_id, "", "why").one_of(error_names),
        output("case", &M::kind, "", "ramps of the move").one_of(move_kind_names),
        output("equation", &M::equation, "",
               "1 to 11, that gave the move its times; 0: from any state"),
        output("duration", &M::duration, "s", "of the move"),
        output("displacement_error", &M::displacement_error, "{unit}",
               "what the segments' times miss the distance by"),
        output("greatest_velocity", &M::greatest_velocity, "{unit}/s", "of the move"),
        output("greatest_acceleration", &M::greatest_acceleration, "{unit}/s^2",
               "of the move, either way"),
    };
    return table;
}

void Move::scan(const Scan& now) {
    if (first_scan) {
        first_scan = false;
        first_time = now.time;
        set({start_position, start_velocity, 0, 0});
    }
    error_id = check();
    if (error_id == MoveError::none) error_id = advance(now.time);
    if (error_id == MoveError::none) {
        command(now.time);
        error_id = refusal;
    }
    publish_state(now.time);
}

MoveError Move::check() const {
    if (!all_finite(target, velocity_limit, acceleration_limit, jerk_limit, end_velocity))
        return MoveError::not_finite;
    return velocity_limit > 0 && acceleration_limit > 0 && jerk_limit > 0
               ? MoveError::none
               : MoveError::limit_not_positive;
}

MoveError Move::advance(std::int64_t time) {
    if (started) return set(positioning.at(time));
    const double t = seconds(time - first_time);
    return set({start_position + start_velocity * t, start_velocity, 0, 0});
}

void Move::command(std::int64_t time) {
    if (!execute) refusal = MoveError::none;
    if (rising_edge(execute, last_execute)) refusal = begin(time);
}

/// From the state set by advance().
MoveError Move::begin(std::int64_t time) {
    const PlanResult result = positioning.begin(
        {position, velocity, acceleration, 0}, target,
        {.Ve = end_velocity, .Vm = velocity_limit, .A = acceleration_limit, .J = jerk_limit}, time);
    if (result != PlanResult::ok) return move_error(result);
    started = true;
    told = false;
    publish_plan();
    return advance(time);
}

void Move::publish_plan() {
    const SevenSegmentPlan& plan = positioning.plan;
    duration = positioning.duration();
    if (positioning.from_any_state) {
        const MotionPlan& motion = positioning.motion;
        kind = MoveKind::from_any_state;
        displacement_error = std::abs(motion.missed);
        greatest_velocity = motion.greatest_velocity();
        greatest_acceleration = motion.greatest_acceleration();
    } else {
        kind = plan.kind;
        displacement_error = plan.displacement_error();
        greatest_velocity = plan.peak;
        greatest_acceleration = std::max(plan.start[1].acceleration, -plan.start[5].acceleration);
    }
    equation = lineshaft::equation(kind);
}

void Move::publish_state(std::int64_t time) {
    error = error_id != MoveError::none;
    const bool ended = started && positioning.finished(time);
    in_end_velocity = ended && positioning.reaches_Ve();
    busy = started && !ended && !error;
    done = ended && !error && (execute || !told);
    told = ended && (told || done);
}

/// What no double can hold is not set.
MoveError Move::set(const MotionState& state) {
    if (!all_finite(state.position, state.velocity, state.acceleration, state.jerk))
        return MoveError::not_finite;
    position = state.position;
    velocity = state.velocity;
    acceleration = state.acceleration;
    jerk = state.jerk;
    return MoveError::none;
}

}  // namespace lineshaft

#include "blocks/circle/path_move.hpp"

#include <algorithm>

#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view path_move_error_names[] = {"none", "not_finite", "negative_length",
                                                      "limit_not_positive", "velocity_above_limit"};

PathMoveError error_of(PlanResult result) {
    switch (result) {
        case PlanResult::ok:
            return PathMoveError::none;
        case PlanResult::negative_length:
            return PathMoveError::negative_length;
        case PlanResult::limit_not_positive:
            return PathMoveError::limit_not_positive;
        case PlanResult::velocity_above_limit:
            return PathMoveError::velocity_above_limit;
        case PlanResult::not_finite:
            break;
    }
    return PathMoveError::not_finite;
}

}  // namespace

std::span<const Field> PathMove::fields() {
    using M = PathMove;
    static const Field table[] = {
        parameter("unit", &M::unit, "", "unit of the path").one_of(axis_unit_names),
        parameter("start_velocity", &M::start_velocity, "{unit}/s", "at the start of the move")
            .at_least(0),
        input("execute", &M::execute, "", "rising edge: the move begins").must_be_set(),
        input("length", &M::length, "{unit}", "of the move").must_be_set(),
        input("velocity_limit", &M::velocity_limit, "{unit}/s", "along the path")
            .above(0)
            .must_be_set(),
        input("acceleration_limit", &M::acceleration_limit, "{unit}/s^2", "both ways").above(0),
        input("jerk_limit", &M::jerk_limit, "{unit}/s^3", "both ways").above(0),
        input("end_velocity", &M::end_velocity, "{unit}/s", "at the end, kept from there on")
            .at_least(0),
        output("position", &M::position, "{unit}", "on the path"),
        output("velocity", &M::velocity, "{unit}/s", "along the path"),
        output("acceleration", &M::acceleration, "{unit}/s^2", "along the path"),
        output("jerk", &M::jerk, "{unit}/s^3", "along the path"),
        output("done", &M::done, "", "the move has ended; until `execute` falls"),
        output("busy", &M::busy, "", "the move is under way"),
        output("error", &M::error, "", "the move is refused"),
        output("error_id", &M::error_id, "", "why").one_of(path_move_error_names),
        output("case", &M::kind, "", "ramps of the move").one_of(move_kind_names),
        output("equation", &M::equation, "", "1 to 11, that gave the move its times"),
        output("duration", &M::duration, "s", "of the move"),
        output("displacement_error", &M::displacement_error, "{unit}",
               "what the segments' times miss the length by"),
        output("greatest_velocity", &M::greatest_velocity, "{unit}/s", "of the move"),
        output("greatest_acceleration", &M::greatest_acceleration, "{unit}/s^2",
               "of the move, either way"),
    };
    return table;
}

void PathMove::scan(const Scan& now) {
    if (!all_finite(length, velocity_limit, acceleration_limit, jerk_limit, end_velocity)) {
        error_id = PathMoveError::not_finite;
    } else {
        if (!execute || error_id == PathMoveError::not_finite) error_id = PathMoveError::none;
        if (rising_edge(execute, last_execute)) error_id = begin(now.time);
        publish_motion(now.time);
    }
    publish_state(now.time);
}

PathMoveError PathMove::begin(std::int64_t time) {
    const PlanResult result = lineshaft::plan({.Vs = start_velocity,
                                               .Ve = end_velocity,
                                               .Vm = velocity_limit,
                                               .A = acceleration_limit,
                                               .J = jerk_limit,
                                               .L = length},
                                              plan);
    if (result != PlanResult::ok) return error_of(result);
    started = true;
    told = false;
    start_time = time;
    publish_plan();
    return PathMoveError::none;
}

void PathMove::publish_plan() {
    kind = plan.kind;
    equation = lineshaft::equation(kind);
    duration = plan.duration;
    displacement_error = plan.displacement_error();
    greatest_velocity = plan.peak;
    greatest_acceleration = std::max(plan.start[1].acceleration, -plan.start[5].acceleration);
}

void PathMove::publish_motion(std::int64_t time) {
    if (!started) return;
    const double t = seconds(time - start_time);
    const bool ended = t >= plan.duration;
    const MotionState s = ended ? plan.end : plan.at(t);
    position = ended ? s.position + s.velocity * (t - plan.duration) : s.position;
    velocity = s.velocity;
    acceleration = s.acceleration;
    jerk = ended ? 0 : s.jerk;
}

void PathMove::publish_state(std::int64_t time) {
    error = error_id != PathMoveError::none;
    const bool ended = started && seconds(time - start_time) >= plan.duration;
    busy = started && !ended && !error;
    done = ended && !error && (execute || !told);
    told = ended && (told || done);
}

}  // namespace lineshaft

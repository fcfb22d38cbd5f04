#include "blocks/motion/command.hpp"

#include <cstring>
#include <type_traits>

#include <fmt/format.h>

#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

/// By their bytes: a request is of words only, and is compared in each scan.
bool differ(const Request& a, const Request& b) {
    static_assert(std::is_trivially_copyable_v<Request>);
    return std::memcmp(&a, &b, sizeof a) != 0;
}

}  // namespace

void CommandBlock::run(const Scan& now, const Context& context) {
    send(now, context);
    show(context);
}

void CommandBlock::send(const Scan& now, const Context& context) {
    job.called = now.index;
    if (rising_edge(execute, last_execute)) return start(now, context);
    updating = updating && continuous_update;
    const bool is_free = job.in == JobPlace::no_list;
    if ((updating || ends) && is_free && differ(updated(), job.request) && is_at_work(context))
        update(now, context);
}

bool CommandBlock::is_at_work(const Context& context) const {
    if (refusal != MotionError::none) return false;
    const Progress now_at = progress_of(job, context);
    return now_at >= Progress::active && now_at <= Progress::reached;
}

bool CommandState::begin(JobState& job, MotionError refused) {
    started = true;
    told = reached_shown = false;
    refusal = refused;
    if (refusal != MotionError::none) return false;
    ++job.ticket;
    job.progress = job.before = Progress::sent;
    job.has_reached = 0;
    job.told_by = nowhere;
    return true;
}

void CommandBlock::start(const Scan& now, const Context& context) {
    updating = continuous_update;
    if (!begin(job, check())) return;
    job.request = pins;
    context.instance<Axis>(axis).send(context, now, job);
}

/// What ContinuousUpdate or Ends asks for. The BufferMode stays that by which the command has
/// begun.
Request CommandBlock::updated() const {
    Request asked = pins;
    asked.mode = job.request.mode;
    if (ends) asked.command = Command::halt;
    return asked;
}

/// Pins that are no numbers change nothing.
void CommandBlock::update(const Scan& now, const Context& context) {
    if (check() != MotionError::none) return;
    job.request = updated();
    context.instance<Axis>(axis).send(context, now, job);
}

void CommandState::show(const JobState& job, const Context& context) {
    Progress now_at = progress_of(job, context);
    const bool missed = now_at == Progress::aborted && job.has_reached != 0 && !reached_shown;
    if (missed) now_at = Progress::reached;
    const bool refused = refusal != MotionError::none;
    const bool ended = started && (refused || is_end(now_at));
    const bool shown = ended && (execute || !told);
    told = ended;
    busy = started && !ended;
    reached = busy && now_at == Progress::reached;
    reached_shown = reached_shown || reached;
    active = busy && now_at >= Progress::active && !missed;
    error = shown && (refused || now_at == Progress::failed);
    done = shown && !error && now_at == Progress::done;
    command_aborted = shown && !error && now_at == Progress::aborted;
    error_id = !error ? MotionError::none : refused ? refusal : job.error;
}

Progress progress_of(const JobState& job, const Context& context) {
    if (job.told_by == nowhere) return Progress::sent;
    const bool seen = job.told_by == context.task || context.is_published(job.told_by, job.told_in);
    return seen ? job.progress : job.before;
}

std::string CommandBlock::why(const Context& context, const NameOf& name_of) const {
    const std::string hops = error_id == MotionError::master_loop ? loop(context, name_of) : "";
    if (!hops.empty() || axis == nowhere) return hops;
    const AxisUnit unit = context.instance<Axis>(axis).unit;
    const std::string_view name = axis_unit_names[static_cast<std::size_t>(unit)];
    if (error_id == MotionError::out_of_range && is_profile(job.request.command))
        return text_of_profile(job.shortage, name);
    return text_of(error_id, job.shortage, name);
}

std::string CommandBlock::loop(const Context& context, const NameOf& name_of) const {
    const Axis& slave = context.instance<Axis>(axis);
    std::int64_t hop = slave.way_to(context, slave, job.request.coupling);
    if (hop == axis) return fmt::format("'{}' cannot follow itself", name_of(axis));
    if (hop < 0) return {};
    std::string text = fmt::format("'{}'", name_of(hop));
    for (const char* link = " follows "; hop != axis; link = ", which follows ") {
        hop = context.seen_instance<Axis>(hop).way_to(context, slave);
        if (hop < 0) return {};
        text += fmt::format("{}'{}'", link, name_of(hop));
    }
    return text;
}

MotionError CommandBlock::check() const {
    if (axis == nowhere) return MotionError::no_axis;
    if (!pins.coupling.is_finite()) return MotionError::not_finite;
    return all_finite(pins.position, pins.velocity, pins.end_velocity, pins.acceleration,
                      pins.deceleration, pins.jerk, pins.velocity_factor, pins.acceleration_factor,
                      pins.jerk_factor, pins.parameter_value, pins.process_velocity)
               ? MotionError::none
               : MotionError::not_finite;
}

double CommandBlock::covered(const Context& context, const Axis::Running Axis::*running) const {
    if (refusal != MotionError::none || axis == nowhere) return 0;
    if (is_end(progress_of(job, context))) return job.told_value;
    const Axis::Running& at_work = context.seen_instance<Axis>(axis).*running;
    const bool is_own = at_work.place == context.place_of(job) && at_work.ticket == job.ticket;
    return is_own ? at_work.covered : 0;
}

namespace pin {

Field axis() {
    return in_out("Axis", &CommandBlock::axis, Axis::type, "that is commanded")
        .one_of(axis_unit_names);
}

Field execute() {
    return input("Execute", &CommandBlock::execute, "", "rising edge: the command begins");
}

Field continuous_update() {
    return input(
        "ContinuousUpdate", &CommandBlock::continuous_update, "",
        "pins that change count at once, if it is true at the edge, until it goes false or "
        "the command ends");
}

Field ends() {
    return local("Ends", &CommandBlock::ends, "",
                 "what the command has begun, and nothing else, comes to standstill as by MC_Halt");
}

Field position(std::string_view doc) {
    return input("Position", &CommandBlock::pins, &Request::position, "{Axis}", doc);
}

Field distance() {
    return input("Distance", &CommandBlock::pins, &Request::position, "{Axis}",
                 "way, with its sign");
}

Field velocity(std::string_view doc) {
    return input("Velocity", &CommandBlock::pins, &Request::velocity, "{Axis}/s", doc);
}

Field end_velocity() {
    return input("EndVelocity", &CommandBlock::pins, &Request::end_velocity, "{Axis}/s",
                 "at the end, and from there on; above 0 in the direction of the move");
}

Field acceleration() {
    return input("Acceleration", &CommandBlock::pins, &Request::acceleration, "{Axis}/s^2",
                 "limit where the speed grows; below 0: the axis' own");
}

Field deceleration() {
    return input("Deceleration", &CommandBlock::pins, &Request::deceleration, "{Axis}/s^2",
                 "limit where the speed falls; below 0: the axis' own");
}

Field jerk() {
    return input("Jerk", &CommandBlock::pins, &Request::jerk, "{Axis}/s^3",
                 "limit; 0: a trapezoid, whose acceleration comes in a nanosecond; below 0: the "
                 "axis' own");
}

Field direction(std::string_view doc) {
    return input("Direction", &CommandBlock::pins, &Request::direction, "", doc)
        .one_of(move_direction_names);
}

Field buffer_mode() {
    return input("BufferMode", &CommandBlock::pins, &Request::mode, "",
                 "what becomes of the command at work")
        .one_of(buffer_mode_names);
}

Field execution_mode() {
    return input("ExecutionMode", &CommandBlock::pins, &Request::mode, "",
                 "at once, or when what is at work and waits has ended")
        .one_of(execution_mode_names);
}

Field done(std::string_view doc) {
    return output("Done", &CommandBlock::done, "", doc);
}

Field reached(std::string_view name, std::string_view doc) {
    return output(name, &CommandBlock::reached, "", doc);
}

std::vector<Field> table(std::initializer_list<Field> inputs, const Field& first_output) {
    std::vector<Field> fields{axis(), execute()};
    fields.insert(fields.end(), inputs);
    fields.insert(
        fields.end(),
        {first_output, output("Busy", &CommandBlock::busy, "", "the command has not ended yet"),
         output("Active", &CommandBlock::active, "", "it controls the axis"),
         output("CommandAborted", &CommandBlock::command_aborted, "",
                "another command has taken over"),
         output("Error", &CommandBlock::error, "",
                "the command is refused, or the axis has failed"),
         output("ErrorID", &CommandBlock::error_id, "", "why").one_of(motion_error_names),
         local("Rules", &CommandBlock::pins, &Request::rules, "",
               "whose rules count for what waits, halts, is reset and comes on top")
             .one_of(command_rules_names)});
    return fields;
}

}  // namespace pin

}  // namespace lineshaft

#include "blocks/motion/probes.hpp"

#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view side_names[] = {"mcBoth", "mcPositive", "mcNegative"};

/// Over the end of a modulo axis where `last` lies below `first`.
bool is_within(double position, double first, double last) {
    return first <= last ? position >= first && position <= last
                         : position >= first || position <= last;
}

}  // namespace

std::span<const Field> TouchProbe::fields() {
    using B = TouchProbe;
    static const Field table[] = {
        in_out("Axis", &B::axis, Axis::type, "that is probed").one_of(axis_unit_names),
        input("Execute", &B::execute, "", "rising edge: the probe waits"),
        input("TriggerInput", &B::trigger, "", "rising edge: the position is recorded"),
        input("WindowOnly", &B::window_only, "", "only within the two positions"),
        input("FirstPosition", &B::first_position, "{Axis}", "of the window"),
        input("LastPosition", &B::last_position, "{Axis}", "of the window"),
        output("Done", &B::done, "", "a position is recorded"),
        output("Busy", &B::busy, "", "the probe waits"),
        output("CommandAborted", &B::command_aborted, "", "MC_AbortTrigger has ended it"),
        output("Error", &B::error, "", "the probe is refused"),
        output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names),
        output("RecordedPosition", &B::recorded_position, "{Axis}", "of the axis"),
    };
    return table;
}

void TouchProbe::scan(const Scan&, const Context& context) {
    const bool rises = rising_edge(trigger, last_trigger);
    if (rising_edge(execute, last_execute)) {
        told = false;
        error_id = axis == nowhere                              ? MotionError::no_axis
                   : !all_finite(first_position, last_position) ? MotionError::not_finite
                                                                : MotionError::none;
        phase = error_id == MotionError::none ? Phase::armed : Phase::refused;
        if (phase == Phase::armed) aborts = context.seen_instance<Axis>(axis).trigger_aborts;
    }
    if (phase == Phase::armed) look(context.seen_instance<Axis>(axis), rises);
    show();
}

void TouchProbe::look(const Axis& seen, bool rises) {
    if (seen.trigger_aborts != aborts) {
        phase = Phase::aborted;
        return;
    }
    const double position = seen.actual().position;
    if (!rises || (window_only && !is_within(position, first_position, last_position))) return;
    recorded_position = position;
    phase = Phase::recorded;
}

void TouchProbe::show() {
    busy = phase == Phase::armed;
    const bool ended = phase > Phase::armed;
    const bool shown = ended && (execute || !told);
    told = ended;
    done = shown && phase == Phase::recorded;
    command_aborted = shown && phase == Phase::aborted;
    error = shown && phase == Phase::refused;
    if (!error) error_id = MotionError::none;
}

std::span<const Field> command_kinds::abort_trigger_fields() {
    static const auto fields = pin::table({}, pin::done("no probe of the axis waits any more"));
    return fields;
}

std::span<const Field> DigitalCamSwitch::fields() {
    using B = DigitalCamSwitch;
    static const auto table = read_table({
        input("FirstOnPosition", &B::first_on_position, "{Axis}", "Output is true from here"),
        input("LastOnPosition", &B::last_on_position, "{Axis}", "to here"),
        input("AxisDirection", &B::side, "", "in which the cam counts").one_of(side_names),
        input("OnCompensation", &B::on_compensation, "s", "later; below 0: earlier"),
        input("OffCompensation", &B::off_compensation, "s", "later; below 0: earlier"),
        output("Output", &B::is_on, "", "the axis is within the window"),
    });
    return table;
}

void DigitalCamSwitch::scan(const Scan&, const Context& context) {
    const bool was_valid = valid;
    const Axis* seen = look(context);
    if (!seen) is_on = false;
    if (!seen) return;
    const bool finite =
        all_finite(first_on_position, last_on_position, on_compensation, off_compensation);
    error = !finite;
    error_id = finite ? MotionError::none : MotionError::not_finite;
    valid = finite;
    if (!finite) return;
    switch_output(*seen, was_valid);
}

void DigitalCamSwitch::switch_output(const Axis& seen, bool knows_edges) {
    const MotionState now = seen.actual();
    const auto within = [&](double later) {
        const double then = now.position - now.velocity * later;
        return is_within(seen.modulo ? within_period(then, seen.period) : then, first_on_position,
                         last_on_position);
    };
    const bool on = within(on_compensation), off = !within(off_compensation);
    if (!knows_edges) is_on = on && !off;
    if (knows_edges && on && !last_on) is_on = true;
    if (knows_edges && off && !last_off) is_on = false;
    last_on = on;
    last_off = off;
    if (side == Side::positive && now.velocity < 0) is_on = false;
    if (side == Side::negative && now.velocity > 0) is_on = false;
}

}  // namespace lineshaft

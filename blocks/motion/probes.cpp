#include "blocks/motion/probes.hpp"

#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

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
        input("TriggerTime", &B::trigger_time, "ns", "virtual time of that; 0: of the scan"),
        input("WindowOnly", &B::window_only, "", "only within the two positions"),
        input("FirstPosition", &B::first_position, "{Axis}", "of the window"),
        input("LastPosition", &B::last_position, "{Axis}", "of the window"),
        output("Done", &B::done, "", "a position is recorded"),
        output("Busy", &B::busy, "", "the probe waits"),
        output("CommandAborted", &B::command_aborted, "", "MC_AbortTrigger has ended it"),
        output("Error", &B::error, "", "the probe is refused"),
        output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names),
        output("RecordedPosition", &B::recorded_position, "{Axis}", "of the axis"),
        output("RecordedTime", &B::recorded_time, "ns", "virtual time at which it was there"),
    };
    return table;
}

void TouchProbe::scan(const Scan& now, const Context& context) {
    const bool rises = rising_edge(trigger, last_trigger);
    if (rising_edge(execute, last_execute)) arm(context);
    if (axis != nowhere) {
        const Axis& seen = context.seen_instance<Axis>(axis);
        motion.look(seen, MasterValueSource::actual_value);
        if (phase == Phase::armed || phase == Phase::triggered) look(seen, rises, now.time);
    }
    show();
}

void TouchProbe::arm(const Context& context) {
    told = false;
    error_id = axis == nowhere                              ? MotionError::no_axis
               : !all_finite(first_position, last_position) ? MotionError::not_finite
                                                            : MotionError::none;
    phase = error_id == MotionError::none ? Phase::armed : Phase::refused;
    if (phase == Phase::armed) aborts = context.seen_instance<Axis>(axis).trigger_aborts;
}

void TouchProbe::look(const Axis& seen, bool rises, std::int64_t now) {
    if (seen.trigger_aborts != aborts) phase = Phase::aborted;
    if (phase == Phase::armed && rises && !motion.is_empty()) take(now);
    if (phase == Phase::triggered && moment <= motion.end()) record();
}

void TouchProbe::take(std::int64_t now) {
    moment = trigger_time != 0 ? trigger_time : motion.end();
    const bool is_known = moment >= motion.begin() && moment <= now;
    phase = is_known ? Phase::triggered : Phase::refused;
    if (!is_known) error_id = MotionError::out_of_range;
}

void TouchProbe::record() {
    const double position = motion.position_at(moment);
    phase = Phase::armed;
    if (window_only && !is_within(position, first_position, last_position)) return;
    recorded_position = position;
    recorded_time = moment;
    phase = Phase::recorded;
}

void TouchProbe::shift(std::int64_t by) {
    motion.shift(by);
    moment += by;
    if (recorded_time != 0) recorded_time += by;
}

void TouchProbe::show() {
    busy = phase == Phase::armed || phase == Phase::triggered;
    const bool ended = phase > Phase::triggered;
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

}  // namespace lineshaft

#include "blocks/motion/state_commands.hpp"

namespace lineshaft {

std::span<const Field> Power::fields() {
    static const Field table[] = {
        pin::axis(),
        input("Enable", &Power::execute, "", "the power is on"),
        input("EnablePositive", &Power::enable_positive, "", "the axis may move forward"),
        input("EnableNegative", &Power::enable_negative, "", "the axis may move backward"),
        output("Status", &Power::status, "", "the power is on, as the axis has it"),
        output("Valid", &Power::active, "", "Status can be relied on"),
        output("Error", &Power::error, "", "there is no axis"),
        output("ErrorID", &Power::error_id, "", "why").one_of(motion_error_names),
        local("Rules", &CommandBlock::pins, &Request::rules, "",
              "whose rules count for a direction that is not enabled")
            .one_of(command_rules_names),
    };
    return table;
}

void Power::scan(const Scan& now, const Context& context) {
    const bool first = !started;
    const bool changed = first || execute != last_execute ||
                         enable_positive != (pins.enables_positive != 0) ||
                         enable_negative != (pins.enables_negative != 0);
    pins.enables_positive = enable_positive ? 1 : 0;
    pins.enables_negative = enable_negative ? 1 : 0;
    pins.command = execute ? Command::power_on : Command::power_off;
    last_execute = execute;
    if (changed) start(now, context);
    error = refusal != MotionError::none;
    error_id = refusal;
    active = !error;
    if (error) {
        status = false;
        return;
    }
    if (first && !execute) context.instance<Axis>(axis).begin_without_power(context);
    const Axis& seen = context.seen_instance<Axis>(axis);
    const bool is_yet_to_start = seen.started == 0 && seen.needs_power;
    status =
        seen.state != AxisState::disabled && !is_yet_to_start && (execute || seen.switched != 0);
}

std::span<const Field> Stop::fields() {
    static const auto fields = [] {
        auto made = pin::table({pin::deceleration(), pin::jerk()}, pin::done("the axis stands"));
        made.push_back(local("Significance", &CommandBlock::pins, &Request::significance, "",
                             "above 0: it takes over from an MC_Stop that has no greater one"));
        return made;
    }();
    return fields;
}

void Stop::scan(const Scan& now, const Context& context) {
    pins.holds = execute ? 1 : 0;
    const bool released = last_execute && !execute && refusal == MotionError::none;
    run(now, context);
    if (released) update(now, context);
}

std::span<const Field> command_kinds::reset_fields() {
    static const auto fields = pin::table({}, pin::done("the axis has no error"));
    return fields;
}

}  // namespace lineshaft

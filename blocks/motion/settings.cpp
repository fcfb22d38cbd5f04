#include "blocks/motion/settings.hpp"

#include <algorithm>

namespace lineshaft {

namespace {

constexpr std::string_view home_mode_names[] = {"mcDirect", "mcToPosition", "mcOnSignal",
                                                "mcRelative", "mcOther"};

constexpr std::string_view reference_names[] = {"unchanged", "known", "unknown"};

}  // namespace

std::span<const Field> SetPosition::fields() {
    static const auto table = [] {
        auto made = pin::table({pin::position("of the place where the axis is"),
                                input("Relative", &SetPosition::relative, "", "Position is added"),
                                pin::execution_mode()},
                               pin::done("the position is set"));
        made.push_back(local("Reference", &CommandBlock::pins, &Request::reference, "",
                             "known: the axis is homed then, and an absolute move goes to its "
                             "Position as it is now, as Siemens homes; unknown: it is not homed")
                           .one_of(reference_names));
        made.push_back(local("Period", &CommandBlock::pins, &Request::period, "{Axis}",
                             "below 0: Position counts over all turns of a modulo axis"));
        return made;
    }();
    return table;
}

void SetPosition::scan(const Scan& now, const Context& context) {
    pins.relative = relative ? 1 : 0;
    run(now, context);
}

std::span<const Field> WriteParameter::fields() {
    using B = WriteParameter;
    static const auto table =
        pin::table({input("ParameterNumber", &B::pins, &Request::parameter, "",
                          "2, 3: highest, lowest_position; 4, 5: software_limits; 9, 13, 15, 17: "
                          "default_velocity, _acceleration, _deceleration, _jerk"),
                    input("Value", &B::pins, &Request::parameter_value, "",
                          "in the unit of the axis, and seconds"),
                    pin::execution_mode()},
                   pin::done("the parameter is set"));
    return table;
}

std::span<const Field> WriteBoolParameter::fields() {
    using B = WriteBoolParameter;
    static const auto table =
        pin::table({input("ParameterNumber", &B::pins, &Request::parameter, "",
                          "4 or 5: software limits, both at once"),
                    input("Value", &B::value, "", "on"), pin::execution_mode()},
                   pin::done("the parameter is set"));
    return table;
}

void WriteBoolParameter::scan(const Scan& now, const Context& context) {
    pins.parameter_value = value ? 1 : 0;
    run(now, context);
}

std::span<const Field> SetOverride::fields() {
    using B = SetOverride;
    static const Field table[] = {
        pin::axis(),
        input("Enable", &B::execute, "", "true: the factors count, and go on to when it falls"),
        input("VelFactor", &B::pins, &Request::velocity_factor, "", "of velocities; 0: standstill")
            .at_least(0),
        input("AccFactor", &B::pins, &Request::acceleration_factor, "",
              "of accelerations and decelerations")
            .above(0),
        input("JerkFactor", &B::pins, &Request::jerk_factor, "", "of jerks").above(0),
        output("Enabled", &B::done, "", "the factors are those of the axis"),
        output("Busy", &B::busy, "", "the axis has not taken them yet"),
        output("Error", &B::error, "", "the factors are refused"),
        output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names),
    };
    return table;
}

void SetOverride::scan(const Scan& now, const Context& context) {
    const bool changed = started && refusal == MotionError::none && pins != job.request;
    if (execute && last_execute && changed)
        start(now, context);
    else
        send(now, context);
    show(context);
    done = done && execute;
}

std::span<const Field> Home::fields() {
    static const auto table = [] {
        auto made = pin::table(
            {pin::position("that is known then"),
             input("HomingMode", &Home::mode, "",
                   "how; mcOther, which stands for modes of other controllers, is refused")
                 .one_of(home_mode_names),
             input("Signal", &Home::signal, "", "of a switch, for mcOnSignal: its rising edge"),
             pin::velocity(), pin::direction(), pin::acceleration(), pin::deceleration(),
             pin::jerk(), pin::buffer_mode()},
            pin::done("the position is known"));
        made.push_back(local("Reference", &CommandBlock::pins, &Request::reference, "",
                             "unchanged: Signal is searched, and the position stays")
                           .one_of(reference_names));
        return made;
    }();
    return table;
}

/// It begins standing: blending is waiting.
void Home::scan(const Scan& now, const Context& context) {
    const BufferMode wanted = pins.mode;
    pins.mode = std::min(wanted, BufferMode::buffered);
    look(now, context);
    pins.mode = wanted;
}

void Home::look(const Scan& now, const Context& context) {
    pins.homing = mode;
    if (execute && !last_execute) signalled = false;
    run(now, context);
    const bool rises = rising_edge(signal, last_signal);
    if (!active || signalled || !rises || mode != HomingMode::on_signal) return;
    signalled = true;
    pins.homing = HomingMode::signalled;
    update(now, context);
}

}  // namespace lineshaft

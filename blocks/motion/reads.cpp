#include "blocks/motion/reads.hpp"

#include <cmath>

namespace lineshaft {

std::vector<Field> read_table(std::initializer_list<Field> own) {
    std::vector<Field> fields{
        in_out("Axis", &ReadBlock::axis, Axis::type, "that is looked at").one_of(axis_unit_names),
        input("Enable", &ReadBlock::enable, "", "the outputs follow the axis"),
        output("Valid", &ReadBlock::valid, "", "the outputs can be relied on"),
        output("Busy", &ReadBlock::busy, "", "the block looks at the axis"),
        output("Error", &ReadBlock::error, "", "there is nothing to tell"),
        output("ErrorID", &ReadBlock::error_id, "", "why").one_of(motion_error_names)};
    fields.insert(fields.end(), own);
    return fields;
}

const Axis* ReadBlock::look(const Context& context) {
    error = enable && axis == nowhere;
    error_id = error ? MotionError::no_axis : MotionError::none;
    valid = busy = enable && !error;
    return valid ? &context.seen_instance<Axis>(axis) : nullptr;
}

std::span<const Field> ReadStatus::fields() {
    static const auto table = [] {
        constexpr std::string_view names[] = {
            "Disabled",         "Standstill",         "Homing",   "Stopping", "DiscreteMotion",
            "ContinuousMotion", "SynchronizedMotion", "ErrorStop"};
        auto fields = read_table({});
        const std::size_t first = detail::offset_of(&ReadStatus::states);
        for (std::size_t i = 0; i < axis_state_count; ++i) {
            Field state;
            state.name = names[i];
            state.doc = "the axis is in that state";
            state.direction = Direction::output;
            state.type = Type::boolean;
            state.offset = first + i;
            fields.push_back(state);
        }
        return fields;
    }();
    return table;
}

void ReadStatus::scan(const Scan&, const Context& context) {
    const Axis* seen = look(context);
    for (std::size_t i = 0; i < axis_state_count; ++i)
        states[i] = seen && static_cast<std::size_t>(seen->state) == i;
}

namespace {

constexpr std::string_view source_names[] = {"mcCommandedValue", "mcSetValue", "mcActualValue"};

}  // namespace

std::span<const Field> ReadMotionState::fields() {
    using B = ReadMotionState;
    static const auto table = read_table({
        input("Source", &B::source, "", "the set-point, or what the drive measures")
            .one_of(source_names),
        output("ConstantVelocity", &B::constant_velocity, "", "0 too"),
        output("Accelerating", &B::accelerating, "", "the speed grows"),
        output("Decelerating", &B::decelerating, "", "the speed falls"),
        output("DirectionPositive", &B::direction_positive, "", "the position grows"),
        output("DirectionNegative", &B::direction_negative, "", "the position falls"),
    });
    return table;
}

void ReadMotionState::scan(const Scan&, const Context& context) {
    const Axis* seen = look(context);
    const bool is_measured = seen && seen->has_drive && source == Source::actual_value;
    if (is_measured) measure(*seen);
    has_looked = is_measured;
    const double v = is_measured ? last_velocity : seen ? seen->velocity : 0;
    const double a = is_measured ? change : seen ? seen->acceleration : 0;
    const bool starts = v == 0 && a != 0;
    constant_velocity = seen && a == 0;
    accelerating = v * a > 0 || starts;
    decelerating = v * a < 0;
    direction_positive = v > 0;
    direction_negative = v < 0;
}

void ReadMotionState::measure(const Axis& seen) {
    if (has_looked && seen.scan_time == last_time) return;
    const double v = seen.actual().velocity;
    change = has_looked ? v - last_velocity : 0;
    last_velocity = v;
    last_time = seen.scan_time;
}

std::span<const Field> ReadAxisInfo::fields() {
    using B = ReadAxisInfo;
    static const auto table = read_table({
        output("HomeAbsSwitch", &B::home_abs_switch, "", "never: the switch is Signal of MC_Home"),
        output("LimitSwitchPos", &B::limit_switch_positive, "",
               "with software_limits: the axis is at the highest position, or beyond"),
        output("LimitSwitchNeg", &B::limit_switch_negative, "",
               "with software_limits: the axis is at the lowest position, or beyond"),
        output("Simulation", &B::simulation, "", "the axis has no drive"),
        output("CommunicationReady", &B::communication_ready, "", "always, while Valid"),
        output("ReadyForPowerOn", &B::ready_for_power_on, "", "the axis has no error"),
        output("PowerOn", &B::power_on, "", "as MC_Power wants it"),
        output("IsHomed", &B::is_homed, "", "by MC_Home"),
        output("AxisWarning", &B::axis_warning, "",
               "the axis is outside of its software limits: it may only come in"),
    });
    return table;
}

void ReadAxisInfo::scan(const Scan&, const Context& context) {
    const Axis* seen = look(context);
    const bool limited = seen && seen->software_limits;
    const double position = seen ? seen->actual().position : 0;
    limit_switch_positive = limited && position >= seen->highest_position;
    limit_switch_negative = limited && position <= seen->lowest_position;
    axis_warning =
        limited && (position > seen->highest_position || position < seen->lowest_position);
    simulation = seen && !seen->has_drive;
    communication_ready = valid;
    ready_for_power_on = seen && seen->state != AxisState::error_stop;
    power_on = seen && seen->powered != 0;
    is_homed = seen && seen->homed;
}

std::span<const Field> ReadAxisError::fields() {
    static const auto table =
        read_table({output("AxisErrorID", &ReadAxisError::axis_error, "", "of the axis")
                        .one_of(motion_error_names)});
    return table;
}

void ReadAxisError::scan(const Scan&, const Context& context) {
    const Axis* seen = look(context);
    axis_error = seen ? seen->error_id : MotionError::none;
}

std::span<const Field> ReadActualPosition::fields() {
    static const auto table =
        read_table({output("Position", &ReadActualPosition::position, "{Axis}", "of the axis")});
    return table;
}

void ReadActualPosition::scan(const Scan&, const Context& context) {
    if (const Axis* seen = look(context)) position = seen->actual().position;
}

std::span<const Field> ReadSetPosition::fields() {
    static const auto table =
        read_table({output("Position", &ReadSetPosition::position, "{Axis}", "of the set-point")});
    return table;
}

void ReadSetPosition::scan(const Scan&, const Context& context) {
    if (const Axis* seen = look(context)) position = seen->position;
}

std::span<const Field> ReadActualVelocity::fields() {
    static const auto table =
        read_table({output("Velocity", &ReadActualVelocity::velocity, "{Axis}/s", "of the axis")});
    return table;
}

void ReadActualVelocity::scan(const Scan&, const Context& context) {
    if (const Axis* seen = look(context)) velocity = seen->actual().velocity;
}

std::span<const Field> ReadParameter::fields() {
    static const auto table = read_table({
        input("ParameterNumber", &ReadParameter::number, "",
              "1: position; 10, 11: measured velocity, velocity; and those of MC_WriteParameter"),
        output("Value", &ReadParameter::value, "", "in the unit of the axis, and seconds"),
    });
    return table;
}

void ReadParameter::scan(const Scan&, const Context& context) {
    const Axis* seen = look(context);
    if (!seen) return;
    const auto found = seen->read_parameter(number);
    value = found.value_or(0);
    valid = found.has_value();
    error = !found;
    error_id = error ? MotionError::no_such_parameter : MotionError::none;
}

std::span<const Field> ReadBoolParameter::fields() {
    using B = ReadBoolParameter;
    static const auto table = read_table({
        input("ParameterNumber", &B::number, "", "4 or 5: software limits"),
        output("Value", &B::value, "", "it is on"),
    });
    return table;
}

void ReadBoolParameter::scan(const Scan&, const Context& context) {
    const Axis* seen = look(context);
    if (!seen) return;
    valid = is_bool_parameter(number);
    value = valid && seen->read_parameter(number) != 0.0;
    error = !valid;
    error_id = error ? MotionError::no_such_parameter : MotionError::none;
}

}  // namespace lineshaft

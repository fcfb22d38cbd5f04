#include "blocks/motion/digital_signals.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view input_names[] = {
    "in1",  "in2",  "in3",  "in4",  "in5",  "in6",  "in7",  "in8",  "in9",  "in10", "in11",
    "in12", "in13", "in14", "in15", "in16", "in17", "in18", "in19", "in20", "in21", "in22",
    "in23", "in24", "in25", "in26", "in27", "in28", "in29", "in30", "in31", "in32"};
constexpr std::string_view signal_names[] = {
    "out1",  "out2",  "out3",  "out4",  "out5",  "out6",  "out7",  "out8",
    "out9",  "out10", "out11", "out12", "out13", "out14", "out15", "out16",
    "out17", "out18", "out19", "out20", "out21", "out22", "out23", "out24",
    "out25", "out26", "out27", "out28", "out29", "out30", "out31", "out32"};
static_assert(std::size(input_names) == digital_signals);
static_assert(std::size(signal_names) == digital_signals);

std::vector<Field> signal_fields(Direction direction, std::span<const std::string_view> names,
                                 std::size_t offset, std::string_view doc) {
    std::vector<Field> fields;
    for (const std::string_view name : names) {
        Field field;
        field.name = name;
        field.doc = doc;
        field.direction = direction;
        field.type = Type::boolean;
        field.offset = offset + fields.size();
        fields.push_back(field);
    }
    return fields;
}

bool is_signal(std::int64_t number) {
    return number >= 1 && number <= digital_signals;
}

MotionError check(std::int64_t signals, std::int64_t number) {
    if (signals == nowhere) return MotionError::no_reference;
    return is_signal(number) ? MotionError::none : MotionError::out_of_range;
}

std::vector<Field> digital_table(std::string_view reference, std::string_view kind,
                                 std::string_view number) {
    using B = ReadDigital;
    return {in_out(reference, &B::signals, kind, "that are looked at"),
            input("Enable", &B::enable, "", "Value follows the signal"),
            input(number, &B::number, "", "1..32"),
            output("Valid", &B::valid, "", "Value can be relied on"),
            output("Busy", &B::busy, "", "the block looks at the signal"),
            output("Error", &B::error, "", "there is nothing to tell"),
            output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names),
            output("Value", &B::value, "", "of the signal")};
}

}  // namespace

std::span<const Field> DigitalInputs::fields() {
    static const auto fields = signal_fields(
        Direction::input, input_names, detail::offset_of(&DigitalInputs::in), "of the machine");
    return fields;
}

std::span<const Field> DigitalOutputs::fields() {
    static const auto fields =
        signal_fields(Direction::output, signal_names, detail::offset_of(&DigitalOutputs::out),
                      "as MC_WriteDigitalOutput has set it");
    return fields;
}

void DigitalOutputs::scan(const Scan&, const Context& context) {
    for (std::size_t i = 0; i < writes.size(); ++i) {
        Write& next = writes[i];
        if (!next.waits || !context.is_published(next.task, next.scan)) continue;
        out[i] = next.value;
        next.waits = false;
        next.taken = next.ticket;
    }
}

std::int64_t DigitalOutputs::write(std::int64_t number, bool wanted, const Scan& now,
                                   const Context& context) {
    Write& next = writes[static_cast<std::size_t>(number - 1)];
    next = {true, wanted, next.ticket + 1, next.taken, context.task, now.index};
    return next.ticket;
}

bool ReadDigital::look() {
    error_id = enable ? check(signals, number) : MotionError::none;
    error = error_id != MotionError::none;
    valid = busy = enable && !error;
    if (!valid) value = false;
    return valid;
}

std::span<const Field> ReadDigitalInput::fields() {
    static const auto table = digital_table("Input", DigitalInputs::type, "InputNumber");
    return table;
}

void ReadDigitalInput::scan(const Scan&, const Context& context) {
    if (!look()) return;
    value = context.seen_instance<DigitalInputs>(signals).in[static_cast<std::size_t>(number - 1)];
}

std::span<const Field> ReadDigitalOutput::fields() {
    static const auto table = digital_table("Output", DigitalOutputs::type, "OutputNumber");
    return table;
}

void ReadDigitalOutput::scan(const Scan&, const Context& context) {
    if (!look()) return;
    value =
        context.seen_instance<DigitalOutputs>(signals).out[static_cast<std::size_t>(number - 1)];
}

std::span<const Field> WriteDigitalOutput::fields() {
    using B = WriteDigitalOutput;
    static const Field table[] = {
        in_out("Output", &B::signals, DigitalOutputs::type, "of which one is set"),
        input("Execute", &B::execute, "", "rising edge: the output is set"),
        input("OutputNumber", &B::number, "", "1..32"),
        input("Value", &B::value, "", "of the output"),
        input("ExecutionMode", &B::mode, "", "mcImmediately: mcQueued is refused")
            .one_of(execution_mode_names),
        output("Done", &B::done, "", "the output has the value"),
        output("Busy", &B::busy, "", "it has not taken it yet"),
        output("Error", &B::error, "", "there is no such output"),
        output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names),
    };
    return table;
}

void WriteDigitalOutput::scan(const Scan& now, const Context& context) {
    if (rising_edge(execute, last_execute)) start(now, context);
    if (waits) {
        const auto& outputs = context.seen_instance<DigitalOutputs>(signals);
        waits = outputs.writes[static_cast<std::size_t>(written - 1)].taken < ticket;
    }
    const bool shown = !waits && (execute || !told);
    told = told || !waits;
    busy = waits;
    error = shown && error_id != MotionError::none;
    done = shown && written != 0 && !error;
    if (!error) error_id = MotionError::none;
}

void WriteDigitalOutput::start(const Scan& now, const Context& context) {
    told = waits = false;
    written = 0;
    error_id = mode == BufferMode::aborting ? check(signals, number) : MotionError::out_of_range;
    if (error_id != MotionError::none) return;
    written = number;
    ticket = context.instance<DigitalOutputs>(signals).write(number, value, now, context);
    waits = true;
}

}  // namespace lineshaft

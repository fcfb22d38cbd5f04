#include "runtime/names/resolve.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

/// `fast`, `Mode.fast`, `Mode#fast`
bool is_name(const Node& value) {
    std::string text = value.text;
    std::ranges::replace_if(
        text, [](char c) { return c == '.' || c == '#'; }, '_');
    return !value.quoted && is_identifier(text);
}

/// Empty, and reported, when the text is not a value of an input. What is a name is one of the
/// enumeration that the input feeds: its own names are those, once it is wired.
std::optional<Signal> read_input(const Reader& read, const Node& value, Value& initial) {
    Signal signal;
    if (!value.quoted && (value.text == "true" || value.text == "false")) {
        signal.type = Type::boolean;
        initial = value.text == "true";
        return signal;
    }
    if (is_name(value)) {
        signal.type = Type::enumeration;
        return signal;
    }
    const auto quantity = read.quantity(value);
    if (!quantity) return {};
    if (quantity->is_integer && !quantity->has_unit) {
        const auto with_sign = whole_value(quantity->integer, Type::integer);
        signal.type = with_sign ? Type::integer : Type::unsigned_integer;
        initial = *whole_value(quantity->integer, signal.type);
    } else {
        signal.type = Type::real;
        signal.unit = quantity->unit.text;
        initial = quantity->number;
    }
    return signal;
}

void resolve_inputs(Resolving& to) {
    for (const auto& [name, value] : to.program.inputs) {
        InputNode input{.name = name.text};
        input.signal = read_input(to.read, value, input.initial);
        if (input.signal) {
            input.signal->name = "inputs." + name.text;
            input.signal->port = {-1, static_cast<int>(to.net.inputs.size())};
            input.field.type = input.signal->type;
            input.field.direction = Direction::input;
        }
        to.net.inputs.push_back(std::move(input));
    }
}

/// The fields that an input is wired to.
std::vector<Port> targets_of(const Resolving& to, const InputNode& input) {
    std::vector<Port> targets;
    for (const Assignment& assignment : to.assignments)
        if (assignment.wire && assignment.wire->signal == "inputs." + input.name)
            targets.push_back(to.net.port(assignment.instance, *assignment.field));
    return targets;
}

/// The number is as many of that unit, and that is a whole one.
std::optional<std::int64_t> whole_in(const Net& net, const InputNode& input, const Unit& unit) {
    const Unit& given = net.unit(input.signal->unit);
    if (!given.same_dimension(unit)) return {};
    const double number = convert(as_real(input.initial), given, unit);
    if (!(std::abs(number) < 0x1p53) || number != std::floor(number)) return {};
    return static_cast<std::int64_t>(number);
}

/// What is written as 20 is a real number to a pin that takes these, and what is written as 1 kHz a
/// whole one to a pin that counts Hz.
void take_types(Resolving& to) {
    for (InputNode& input : to.net.inputs) {
        const auto targets = targets_of(to, input);
        const auto all = [&](const auto& holds) { return std::ranges::all_of(targets, holds); };
        if (!input.signal || targets.empty()) continue;
        Signal& signal = *input.signal;
        const Unit& unit = to.net.unit_of(targets.front());
        if (is_integer(signal.type)) {
            if (!all([&](Port port) { return to.net.field(port).type == Type::real; })) continue;
            input.initial = as_real(input.initial);
            signal.type = Type::real;
        } else if (signal.type == Type::real && !signal.unit.empty()) {
            const auto number = whole_in(to.net, input, unit);
            if (!number || !all([&](Port port) {
                    return is_integer(to.net.field(port).type) &&
                           to.net.unit_of(port).text == unit.text;
                }))
                continue;
            input.initial = *number;
            signal.type = Type::integer;
            signal.unit = unit.text;
        }
        input.field.type = signal.type;
    }
}

void resolve_outputs(Resolving& to) {
    for (const auto& [name, shown] : to.program.outputs) {
        OutputNode output{.name = name.text};
        const auto parts = split_signal(shown.text);
        if (parts && parts->owner == "outputs")
            to.read.fail(code::unknown_signal, shown,
                         fmt::format("'{}' is an output itself", shown.text),
                         "an output shows a signal block.port");
        else
            output.shows = to.net.find(to.read, shown, shown.text);
        to.net.outputs.push_back(std::move(output));
    }
}

}  // namespace

Net resolve(const Program& program, const Catalog& catalog, std::shared_ptr<const Catalog> kinds,
            Diagnostics& out) {
    Resolving to{program, catalog, Reader(out)};
    to.net.catalog = &catalog;
    to.net.kinds = std::move(kinds);
    resolve_tasks(to);
    resolve_instances(to);
    resolve_inputs(to);
    resolve_assignments(to);
    resolve_io(to);
    resolve_constants(to);
    take_types(to);
    resolve_wires(to);
    resolve_outputs(to);
    return std::move(to.net);
}

}  // namespace lineshaft

#include "runtime/names/resolve.hpp"

#include <algorithm>

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
    resolve_wires(to);
    resolve_outputs(to);
    return std::move(to.net);
}

}  // namespace lineshaft

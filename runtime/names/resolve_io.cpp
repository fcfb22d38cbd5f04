#include <algorithm>

#include <fmt/format.h>

#include "runtime/names/resolve.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

/// What the address is wired to is what a block could be wired to.
void wire_input(Resolving& to, const Node& address, const Node& value, Port port) {
    Assignment made{port.instance, &to.net.field(port), &value, parse_wire(value)};
    if (made.wire) return to.assignments.push_back(std::move(made));
    to.read.fail(code::unknown_signal, value, fmt::format("'{}' is not a signal", value.text),
                 fmt::format("write \"{}\": inputs.name, or block.output", address.text));
}

bool is_given(const Resolving& to, const Assignment& made) {
    return std::ranges::any_of(to.assignments, [&](const Assignment& other) {
        return other.instance == made.instance && other.field == made.field;
    });
}

/// An output is shown when all blocks of its task have been scanned.
void wire_output(Resolving& to, const Node& address, const Node& value, Port port) {
    const auto name = split_signal(value.text);
    if (!name)
        return to.read.fail(code::unknown_signal, value,
                            fmt::format("'{}' is not an input of a block", value.text),
                            fmt::format("write \"{}\": block.input", address.text));
    const int number = to.net.find_block(to.read, value, name->owner);
    if (number < 0 || !to.net.instance(number).known()) return;
    const Instance& block = to.net.instance(number);
    const Field* field = block.type->find_settable(name->port);
    if (!field || field->direction != Direction::input)
        return to.read.fail(code::port_cannot_be_set, value,
                            fmt::format("'{}' is no input of {}", name->port, block.described()),
                            fmt::format("'lineshaft blocks {}' lists them", block.type->name));
    const bool same_task = block.task == to.net.instance(port).task;
    Assignment made{number, field, &value, WireText{address.text, false, same_task}};
    if (is_given(to, made))
        return to.read.fail(code::port_cannot_be_set, value,
                            fmt::format("'{}' is set already", value.text),
                            "leave it out there, or here");
    const auto behind = std::ranges::upper_bound(to.assignments, number, {}, &Assignment::instance);
    to.assignments.insert(behind, std::move(made));
}

}  // namespace

void resolve_io(Resolving& to) {
    for (const auto& [address, value] : to.program.io) {
        const auto signal = to.net.find(to.read, address, address.text);
        if (!signal || !to.read.expect_scalar(value, fmt::format("'{}'", address.text))) continue;
        const bool is_address = address.text.starts_with('%');
        const Direction direction =
            is_address ? to.net.field(signal->port).direction : Direction::parameter;
        if (direction == Direction::input)
            wire_input(to, address, value, signal->port);
        else if (direction == Direction::output)
            wire_output(to, address, value, signal->port);
        else
            to.read.fail(code::unknown_signal, address,
                         fmt::format("'{}' is not wired by 'io'", address.text),
                         "'io' wires inputs %I and outputs %Q; what is in %M is traced, set and "
                         "forced by its address");
    }
}

}  // namespace lineshaft

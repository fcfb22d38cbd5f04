#include <algorithm>

#include <fmt/format.h>

#include "runtime/net/linker.hpp"

namespace lineshaft {

std::string kind(Type type, std::span<const std::string_view> names) {
    return type == Type::enumeration ? fmt::format("one of {}", fmt::join(names, ", "))
                                     : std::string(name_of(type));
}

const Unit& Linker::parsed(const std::string& text) {
    const auto it = units_.find(text);
    if (it != units_.end()) return it->second;
    return units_.emplace(text, Unit::parse(text).value()).first->second;
}

/// `{unit}/s` with the block's own parameter `unit` put in.
Unit Linker::unit_of(const Instance& block, const Field& field) {
    std::string text(field.unit);
    for (auto open = text.find('{'); open != std::string::npos; open = text.find('{')) {
        const auto close = text.find('}', open);
        const Field& chosen = *block.type->find_settable(text.substr(open + 1, close - open - 1));
        const Value value = load(chosen.type, block.live + chosen.offset);
        text.replace(open, close - open + 1,
                     describe(value, chosen.type, chosen.names, chosen.unit));
    }
    return parsed(text);
}

Signal Linker::field_signal(const Instance& block, const Field& field) const {
    return {.name = fmt::format("{}.{}", block.plan->name.text, field.name),
            .type = field.type,
            .unit = {},
            .names = field.names,
            .slot = block.published + field.offset,
            .task = block.task};
}

void Linker::collect_signals() {
    for (const Instance& block : blocks_) {
        if (!block.known()) continue;
        for (const Field& field : block.type->fields) {
            if (block.type->find_readable(field.name) != &field) continue;
            Signal signal = field_signal(block, field);
            signal.unit = unit_of(block, field).text;
            out_.machine.signals.push_back(std::move(signal));
        }
    }
}

void Linker::connect_outputs() {
    for (const auto& [name, shown] : program_.outputs) {
        output_names_.push_back(name.text);
        if (shown.text.starts_with("outputs.")) {
            read_.fail("L0208", shown, fmt::format("'{}' is an output itself", shown.text),
                       "an output shows a signal block.port");
            continue;
        }
        auto source = signal(shown);
        if (!source) continue;
        outputs_.emplace(name.text, shown.text);
        source->name = "outputs." + name.text;
        out_.machine.signals.push_back(std::move(*source));
    }
}

/// What is a name in some kind of block is written as it is meant: then there is nothing to guess.
std::string_view Linker::misspelt(std::string_view port) const {
    const bool known = std::ranges::any_of(catalog_.types(), [&](const BlockType& type) {
        return type.find_readable(port) != nullptr;
    });
    return known ? std::string_view() : port;
}

void Linker::unknown_port(const Node& node, const Instance& block, std::string_view port) {
    std::vector<std::string> names;
    for (const Direction d : {Direction::output, Direction::input, Direction::parameter})
        for (const Field& f : block.type->fields)
            if (f.direction == d && std::ranges::find(names, f.name) == names.end())
                names.emplace_back(f.name);
    read_.fail("L0203", node,
               fmt::format("unknown port '{}' on '{}' ({})", port, block.plan->name.text,
                           block.type->name),
               suggest(misspelt(port), names, block.plan->name.text + "."));
}

std::optional<Signal> Linker::signal(const Node& node, const std::string& name) {
    if (name.starts_with("inputs.")) used_inputs_.insert(name.substr(7));
    return find_signal(node, name);
}

std::optional<Signal> Linker::find_signal(const Node& node, const std::string& name) {
    if (!is_signal_name(name)) {
        read_.fail("L0208", node, fmt::format("'{}' is not a signal", name),
                   "a signal is written block.port, inputs.name or outputs.name");
        return {};
    }
    const auto dot = name.find('.');
    const std::string owner = name.substr(0, dot);
    const std::string port = name.substr(dot + 1);
    if (owner == "inputs") {
        if (const auto it = inputs_.find(port); it != inputs_.end()) return it->second;
        if (std::ranges::find(input_names_, port) != input_names_.end()) return {};
        read_.fail("L0208", node, fmt::format("the program has no input '{}'", port),
                   input_names_.empty() ? "it has no 'inputs:'" : suggest(port, input_names_));
        return {};
    }
    if (owner == "outputs") {
        if (const auto it = outputs_.find(port); it != outputs_.end()) {
            auto shown = find_signal(node, it->second);
            shown->name = name;
            return shown;
        }
        if (std::ranges::find(output_names_, port) != output_names_.end()) return {};
        read_.fail("L0208", node, fmt::format("the program has no output '{}'", port),
                   output_names_.empty() ? "it has no 'outputs:'" : suggest(port, output_names_));
        return {};
    }
    const auto it = by_name_.find(owner);
    if (it == by_name_.end()) {
        read_.fail("L0204", node, fmt::format("unknown block '{}'", owner),
                   suggest(owner, block_names_));
        return {};
    }
    const Instance& block = blocks_[static_cast<std::size_t>(it->second)];
    if (!block.known()) return {};
    const Field* field = block.type->find_readable(port);
    if (!field) {
        unknown_port(node, block, port);
        return {};
    }
    Signal signal = field_signal(block, *field);
    signal.unit = unit_of(block, *field).text;
    return signal;
}

}  // namespace lineshaft

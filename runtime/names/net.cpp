#include "runtime/names/net.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/model/address.hpp"
#include "runtime/names/left_out.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/library/library.hpp"
#include "runtime/st/types/types.hpp"

namespace lineshaft {

namespace {

template <class Nodes>
std::vector<std::string> names(const Nodes& nodes) {
    std::vector<std::string> names;
    for (const auto& node : nodes) names.emplace_back(node.name);
    return names;
}

/// `Lamps.lit` of a list of globals, which is `globals.lit`: what to write; empty for any other
/// name.
std::string name_of_listed(const Net& net, std::string_view owner, std::string_view port) {
    const auto globals = net.instance_numbers.find("globals");
    if (globals == net.instance_numbers.end() ||
        net.instance_numbers.contains(std::string(owner)) ||
        !net.instance(globals->second).known() ||
        !net.instance(globals->second).type->find_readable(port))
        return {};
    return fmt::format("write globals.{}, as variables of a list are those of 'globals'", port);
}

}  // namespace

std::string kind(Type type, const ValueNames& names) {
    return type == Type::enumeration ? fmt::format("one of {}", fmt::join(names, ", "))
                                     : std::string(name_of(type));
}

std::string Instance::described() const {
    return fmt::format("'{}' ({})", name, type->name);
}

std::optional<Signal> Net::find(const Reader& read, const Node& node, std::string_view text) const {
    if (text.starts_with('%')) return find_address(read, node, text);
    const auto name = split_signal(text);
    if (!name) {
        const std::string listed = name_of_listed(*this, {}, text);
        read.fail(code::unknown_signal, node, fmt::format("'{}' is not a signal", text),
                  !listed.empty() ? listed
                  : std::ranges::find(inputs, text, &InputNode::name) != inputs.end()
                      ? fmt::format("did you mean 'inputs.{}'?", text)
                      : "a signal is written block.port, inputs.name or outputs.name");
        return {};
    }
    if (name->owner == "inputs") return find_input(read, node, name->port);
    if (name->owner == "outputs") return find_output(read, node, name->port);
    if (const std::string help = name_of_listed(*this, name->owner, name->port); !help.empty()) {
        read.fail(code::unknown_block, node,
                  fmt::format("the program has no block '{}'", name->owner), help);
        return {};
    }
    const int number = find_block(read, node, name->owner);
    if (number < 0 || !instance(number).known()) return {};
    if (const Field* field = instance(number).type->find_readable(name->port))
        return signal(port(number, *field));
    unknown_port(read, node, instance(number), name->port);
    return {};
}

int Net::find_block(const Reader& read, const Node& node, std::string_view name) const {
    const auto it = instance_numbers.find(std::string(name));
    if (it != instance_numbers.end()) return it->second;
    const bool may_be_in_sources = !kinds;
    if (!may_be_in_sources)
        read.fail(code::unknown_block, node, fmt::format("the program has no block '{}'", name),
                  suggest(name, names(instances)));
    return -1;
}

void Net::unknown_port(const Reader& read, const Node& node, const Instance& block,
                       std::string_view port) const {
    if (const auto text = st::find_text(*block.type, port); !text.empty())
        return read.fail(code::unknown_port, node,
                         fmt::format("'{}.{}' is a STRING, which is no signal", block.name, text),
                         fmt::format("compare it in {}, and take the BOOL: is_so := {} = 'text'",
                                     block.type->name, text));
    std::vector<std::string> names;
    using enum Direction;
    for (const Direction d : {output, input, parameter, local})
        for (const Field& f : block.type->fields)
            if (f.direction == d && std::ranges::find(names, f.name) == names.end())
                names.emplace_back(f.name);
    const auto is_part = [&](const std::string& name) {
        return name.size() > port.size() &&
               (name[port.size()] == '.' || name[port.size()] == '[') &&
               same_letters(name.substr(0, port.size()), port);
    };
    if (const auto part = std::ranges::find_if(names, is_part); part != names.end())
        return read.fail(code::unknown_port, node,
                         fmt::format("'{}.{}' is more than one value", block.name, port),
                         fmt::format("name one of them, such as {}.{}", block.name, *part));
    if (refuse_left_out(read, node, block, port)) return;
    read.fail(code::unknown_port, node, fmt::format("{} has no port '{}'", block.described(), port),
              suggest(misspelt(port), names, block.name + "."));
}

std::string_view Net::misspelt(std::string_view port) const {
    const bool known = std::ranges::any_of(catalog->types(), [&](const BlockType& type) {
        return type.find_readable(port) != nullptr;
    });
    return known ? std::string_view() : port;
}

AddressCount Net::count_of_addresses() const {
    const auto it = instance_numbers.find(std::string(st::image_name));
    if (it == instance_numbers.end()) return AddressCount::bytes;
    return st::count_of_addresses(*instance(it->second).type);
}

std::optional<Signal> Net::find_address(const Reader& read, const Node& node,
                                        std::string_view text) const {
    const AddressCount count = count_of_addresses();
    const auto address = read_address(text, count);
    if (!address || address->end() > longest_area) {
        read.fail(
            code::unknown_signal, node, fmt::format("'{}' is not an address", text),
            fmt::format("write the area I, Q or M, the size X, B, W, D or L, and the byte, up "
                        "to {}: \"%IX0.3\", \"%QW4\"",
                        longest_area - 1));
        return {};
    }
    const auto it = instance_numbers.find(std::string(st::image_name));
    const Field* field = it == instance_numbers.end()
                             ? nullptr
                             : instance(it->second).type->find_readable(text_of(*address, count));
    if (field) return signal(port(it->second, *field));
    if (!kinds) return {};
    if (it == instance_numbers.end())
        read.fail(code::unknown_signal, node,
                  fmt::format("the program has no process image for '{}'", text),
                  "its sources name no address: x AT %QW4 : INT");
    else
        read.fail(code::unknown_signal, node,
                  fmt::format("neither the sources nor the program's file name '{}'", text),
                  suggest(text, names(instance(it->second).type->fields)));
    return {};
}

std::optional<Signal> Net::find_input(const Reader& read, const Node& node,
                                      std::string_view name) const {
    const auto it = std::ranges::find(inputs, name, &InputNode::name);
    if (it != inputs.end()) return it->signal;
    read.fail(code::unknown_signal, node, fmt::format("the program has no input '{}'", name),
              inputs.empty() ? "it has no 'inputs:'" : suggest(name, names(inputs)));
    return {};
}

std::optional<Signal> Net::find_output(const Reader& read, const Node& node,
                                       std::string_view name) const {
    const auto it = std::ranges::find(outputs, name, &OutputNode::name);
    if (it == outputs.end()) {
        read.fail(code::unknown_signal, node, fmt::format("the program has no output '{}'", name),
                  outputs.empty() ? "it has no 'outputs:'" : suggest(name, names(outputs)));
        return {};
    }
    auto shown = it->shows;
    if (shown) shown->name = "outputs." + it->name;
    return shown;
}

int Net::find_task(const Reader& read, const Node& node, std::string_view name) const {
    const auto it = std::ranges::find(tasks, name, &TaskSettings::name);
    if (it != tasks.end()) return static_cast<int>(it - tasks.begin());
    if (tasks_known && !name.empty())
        read.fail(code::unknown_task, node, fmt::format("the program has no task '{}'", name),
                  suggest(name, names(tasks)));
    return -1;
}

std::span<const Wire> Net::wires_to(int number) const {
    const auto target = [](const Wire& wire) { return wire.to.instance; };
    const auto first = std::ranges::lower_bound(wires, number, {}, target);
    return {first, std::ranges::upper_bound(first, wires.end(), number, {}, target)};
}

Port Net::port(int number, const Field& field) const {
    return {number, static_cast<int>(&field - instance(number).type->fields.data())};
}

Signal Net::signal(Port port) const {
    const Field& field = this->field(port);
    const std::string& owner = instance(port).name;
    return {.name = owner == st::image_name ? std::string(field.name)
                                            : fmt::format("{}.{}", owner, field.name),
            .type = field.type,
            .unit = unit_of(port).text,
            .names = field.names,
            .task = instance(port).task,
            .port = port};
}

/// Any unit where a reference is missing, which is reported.
std::string Net::chosen_unit(const Instance& block, const Field& chosen) const {
    const Value value = load(chosen.type, block.image.data() + chosen.offset);
    if (chosen.direction != Direction::in_out)
        return describe(value, chosen.type, chosen.names, chosen.unit);
    const auto number = static_cast<int>(std::get<std::int64_t>(value));
    if (number < 0) return std::string(chosen.names.front());
    const Instance& other = instance(number);
    return chosen_unit(other, *other.type->find_settable("unit"));
}

const Unit& Net::unit_of(Port port) const {
    return unit_of(instance(port), field(port).unit);
}

const Unit& Net::unit_of(const Instance& block, std::string_view of_field) const {
    std::string text(of_field);
    for (auto open = text.find('{'); open != std::string::npos; open = text.find('{')) {
        const auto close = text.find('}', open);
        const Field& chosen = *block.type->find_settable(text.substr(open + 1, close - open - 1));
        text.replace(open, close - open + 1, chosen_unit(block, chosen));
    }
    return unit(text);
}

const Unit& Net::unit(const std::string& text) const {
    const auto it = units_.find(text);
    if (it != units_.end()) return it->second;
    return units_.emplace(text, Unit::parse(text).value()).first->second;
}

}  // namespace lineshaft

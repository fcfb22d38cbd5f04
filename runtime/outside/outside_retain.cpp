#include <algorithm>

#include <fmt/format.h>

#include "runtime/outside/outside.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/text_hash.hpp"
#include "runtime/st/library/retained.hpp"
#include "runtime/version.hpp"

namespace lineshaft {

namespace {

/// What a block's memory is laid out by and may have been computed from.
std::string settings_of(const BlockPlace& block) {
    const BlockType& type = *block.type;
    std::string text = fmt::format("{} {} {};", version(), type.name, type.size);
    const auto append = [&](std::size_t offset, std::size_t size) {
        text.append(reinterpret_cast<const char*>(block.live + offset), size);
    };
    for (const Field& field : type.fields) {
        text += fmt::format("{} {} {};", field.name, name_of(field.type), field.offset);
        if (field.direction == Direction::parameter) append(field.offset, size_of(field.type));
    }
    for (const TableField& table : type.tables) {
        append(table.size_offset, sizeof(std::int64_t));
        append(table.rows_offset, table.capacity * table.columns.size() * sizeof(std::int64_t));
    }
    return text_hash(text);
}

void retain_block(Connecting& to, const Node& node) {
    const int number = to.net.find_block(to.read, node, node.text);
    if (number < 0 || !to.net.instance(number).known()) return;
    if (to.net.instance(number).type->is_device())
        return to.read.fail(
            code::cannot_be_retained, node,
            fmt::format("{} is a device and cannot be retained: it starts anew with the power",
                        to.net.instance(number).described()),
            fmt::format("retain some of its outputs, such as {}.position", node.text));
    const auto i = static_cast<std::size_t>(number);
    const BlockPlace& place = to.machine.blocks[i];
    to.machine.retained_blocks.push_back({i, place, settings_of(place)});
}

void warn_of_what_is_not_kept(const Connecting& to, const Node& node, const Signal& signal) {
    const Instance& block = to.net.instance(signal.port);
    to.read.diagnostics().warn(
        code::retained_without_block, node.mark,
        fmt::format("'{}' is retained alone: {} forgets everything else, as the edges it has seen",
                    signal.name, block.described()),
        fmt::format("write the block's name to keep all of it: retain: [{}]", block.name));
}

void retain_signal(Connecting& to, const Node& node) {
    auto kept = find_target(to, node);
    if (!kept) return;
    const bool is_parameter = kept->field.direction == Direction::parameter;
    const Port port = kept->signal.port;
    if (is_parameter ||
        (kept->is_of_block() && to.net.instance(port).wired[static_cast<std::size_t>(port.field)]))
        return to.read.fail(code::cannot_be_retained, node,
                            fmt::format("'{}' is {} and cannot be retained", kept->signal.name,
                                        is_parameter ? "a parameter" : "wired"),
                            "retain blocks, their outputs, and inputs that are set from outside");
    if (kept->is_of_block() && kept->field.direction != Direction::input)
        warn_of_what_is_not_kept(to, node, kept->signal);
    to.machine.retained.push_back({std::move(kept->signal), kept->live, kept->published});
}

bool is_retained(const Machine& machine, const std::byte* live) {
    const auto& values = machine.retained;
    return std::ranges::find(values, live, &Retained::live) != values.end();
}

/// What Structured Text itself retains, unless the program says it too.
void retain_variables(Connecting& to, std::size_t block) {
    const auto& blocks = to.machine.retained_blocks;
    if (!to.net.instances[block].known()) return;
    const auto is_it = [&](const RetainedBlock& kept) {
        return kept.instance == block && !kept.is_part;
    };
    if (std::ranges::any_of(blocks, is_it)) return;
    const BlockPlace& whole = to.machine.blocks[block];
    for (const st::RetainedVariable& variable : st::retained(*whole.type)) {
        const BlockPlace part{.name = fmt::format("{}.{}", whole.name, variable.path),
                              .type = variable.type->standard,
                              .live = whole.live + variable.offset,
                              .published = whole.published + variable.offset};
        if (part.type)
            to.machine.retained_blocks.push_back({block, part, settings_of(part), true});
        else if (!is_retained(to.machine, part.live))
            to.machine.retained_variables.push_back(
                {part.name, variable.type, part.live, part.published, variable.size});
    }
}

}  // namespace

void connect_retained(Connecting& to) {
    for (const Node& node : to.program.retain)
        if (is_identifier(node.text))
            retain_block(to, node);
        else
            retain_signal(to, node);
    for (std::size_t i = 0; i < to.net.instances.size(); ++i) retain_variables(to, i);
}

}  // namespace lineshaft

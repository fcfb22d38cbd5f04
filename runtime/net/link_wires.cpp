#include <algorithm>

#include <fmt/format.h>

#include "runtime/net/linker.hpp"

namespace lineshaft {

std::optional<WireText> parse_wire(const Node& node) {
    if (!node.is_scalar() || node.quoted) return {};
    std::string_view text = node.text;
    WireText wire;
    if (text.starts_with("NOT ")) {
        wire.negated = true;
        text.remove_prefix(4);
    }
    if (text.starts_with("previous(") && text.ends_with(')')) {
        wire.previous = true;
        text = text.substr(9, text.size() - 10);
    }
    wire.signal = text;
    if (!is_signal_name(text) && !wire.negated && !wire.previous) return {};
    return wire;
}

void Linker::wire(int index, const Field& field, const Node& value, const WireText& text) {
    if (text.signal.starts_with("outputs."))
        return read_.fail(
            "L0203", value,
            fmt::format("'{}' is for outside, a wire comes from a block or an input", text.signal),
            "wire the signal that the output shows");
    const auto source = signal(value, text.signal);
    if (!source) return;
    const Instance& block = blocks_[static_cast<std::size_t>(index)];
    wired_.insert(fmt::format("{}.{}", block.plan->name.text, field.name));
    int source_index = -1;
    if (source->task >= 0) {
        const auto dot = text.signal.find('.');
        source_index = by_name_.at(text.signal.substr(0, dot));
        const Instance& from = blocks_[static_cast<std::size_t>(source_index)];
        const Field& port = *from.type->find_readable(text.signal.substr(dot + 1));
        if (port.direction != Direction::output)
            return read_.fail("L0203", value,
                              fmt::format("'{}' is {} {}, not an output", text.signal,
                                          port.direction == Direction::input ? "an" : "a",
                                          name_of(port.direction)),
                              "a wire comes from an output");
    }
    const std::byte* from_slot = source->slot;
    const bool same_task = source_index >= 0 && source->task == block.task;
    if (same_task) {
        const Instance& from = blocks_[static_cast<std::size_t>(source_index)];
        from_slot = from.live + (source->slot - from.published);
    }
    if (text.negated && source->type != Type::boolean)
        return read_.fail(
            "L0408", value,
            fmt::format("NOT is for booleans, '{}' is {}", text.signal, name_of(source->type)));
    const bool widens = source->type == Type::integer && field.type == Type::real;
    const bool narrows = source->type == Type::real && field.type == Type::integer;
    if ((source->type != field.type && !widens) || !std::ranges::equal(source->names, field.names))
        return read_.fail(
            "L0401", value,
            fmt::format("'{}' is {}, '{}' takes {}", text.signal, kind(source->type, source->names),
                        field.name, kind(field.type, field.names)),
            narrows ? "a block converts it: see 'lineshaft explain L0401'" : "");
    const Unit wanted = unit_of(block, field);
    const Unit& given = parsed(source->unit);
    const bool whole = field.type == Type::integer && given.text != wanted.text;
    if (!given.same_dimension(wanted) || whole)
        return read_.fail("L0402", value,
                          fmt::format("'{}' is in {}, '{}' takes {}", text.signal,
                                      given.text.empty() ? "plain numbers" : given.text, field.name,
                                      wanted.text.empty() ? "plain numbers" : wanted.text));
    if (!check_order(index, value, text, source_index)) return;
    BlockWires& wires = wires_[static_cast<std::size_t>(index)];
    const Copy copy{.source = from_slot, .target = block.live + field.offset};
    if (text.negated) return wires.negated.push_back(copy);
    if (given.text != wanted.text)
        return wires.scaled.push_back({.source = copy.source,
                                       .target = copy.target,
                                       .factor = given.numerator * wanted.denominator,
                                       .divisor = given.denominator * wanted.numerator,
                                       .widens = widens});
    if (widens) return wires.widened.push_back(copy);
    (field.type == Type::boolean ? wires.booleans : wires.words).push_back(copy);
}

/// In one task a wire carries this scan's value from an earlier block, and only with `previous()`
/// the last scan's from a later one or the block itself.
bool Linker::check_order(int index, const Node& value, const WireText& text, int source) {
    const Instance& block = blocks_[static_cast<std::size_t>(index)];
    const bool same_task =
        source >= 0 && blocks_[static_cast<std::size_t>(source)].task == block.task;
    const bool later = same_task && source >= index;
    if (later == text.previous) return true;
    if (text.previous) {
        read_.fail("L0407", value,
                   fmt::format("'{}' needs no previous(): {}", text.signal,
                               same_task ? "its block is scanned earlier in this task"
                                         : "it comes from outside of this task"),
                   fmt::format("did you mean '{}'?", text.signal));
        return false;
    }
    const std::string path = loop(index, source);
    if (!path.empty())
        read_.fail(
            "L0404", value, fmt::format("feedback without previous(): {}", path),
            fmt::format("write previous({}) where the loop may be a scan late", text.signal));
    else
        read_.fail("L0404", value,
                   fmt::format("'{}' is scanned after '{}': its value of this scan is not ready",
                               blocks_[static_cast<std::size_t>(source)].plan->name.text,
                               block.plan->name.text),
                   fmt::format("move it before '{}', or write previous({})", block.plan->name.text,
                               text.signal));
    return false;
}

/// The way back from block `to` to block `from` by the wires of their task: `a -> b -> a`; empty if
/// there is none.
std::string Linker::loop(int from, int to) const {
    const int task = blocks_[static_cast<std::size_t>(from)].task;
    std::vector<int> next(blocks_.size(), -1), queue{to};
    std::vector<bool> seen(blocks_.size());
    seen[static_cast<std::size_t>(to)] = true;
    for (std::size_t head = 0; head < queue.size() && queue[head] != from; ++head) {
        for (const auto& [key, value] :
             blocks_[static_cast<std::size_t>(queue[head])].plan->ports) {
            const auto text = parse_wire(value);
            if (!text || text->previous) continue;
            const auto it = by_name_.find(text->signal.substr(0, text->signal.find('.')));
            if (it == by_name_.end() || seen[static_cast<std::size_t>(it->second)]) continue;
            if (blocks_[static_cast<std::size_t>(it->second)].task != task) continue;
            seen[static_cast<std::size_t>(it->second)] = true;
            next[static_cast<std::size_t>(it->second)] = queue[head];
            queue.push_back(it->second);
        }
    }
    if (!seen[static_cast<std::size_t>(from)]) return {};
    const auto name = [this](int i) {
        return blocks_[static_cast<std::size_t>(i)].plan->name.text;
    };
    std::string path = name(from);
    for (int at = from; at != to;) {
        at = next[static_cast<std::size_t>(at)];
        path += " -> " + name(at);
    }
    return path + " -> " + name(from);
}

}  // namespace lineshaft

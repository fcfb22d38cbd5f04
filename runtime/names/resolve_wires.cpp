#include <algorithm>
#include <map>
#include <set>
#include <span>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"
#include "runtime/names/resolve.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

/// The number of the block that a wire comes from; -1 for none.
int source_of(const Net& net, const Assignment& wire) {
    const auto name = split_signal(wire.wire->signal);
    const auto it =
        name ? net.instance_numbers.find(std::string(name->owner)) : net.instance_numbers.end();
    return it == net.instance_numbers.end() ? -1 : it->second;
}

std::span<const Assignment> assignments_of(const Resolving& to, int instance) {
    const auto& all = to.assignments;
    const auto first = std::ranges::lower_bound(all, instance, {}, &Assignment::instance);
    return {first, std::ranges::upper_bound(first, all.end(), instance, {}, &Assignment::instance)};
}

/// The way back from block `to` to block `from` by the wires of their task: `a -> b -> a`; empty if
/// there is none.
std::string loop(const Resolving& resolving, int from, int to) {
    const Net& net = resolving.net;
    std::vector<int> next(net.instances.size(), -1), queue{to};
    std::vector<bool> seen(net.instances.size());
    seen[static_cast<std::size_t>(to)] = true;
    for (std::size_t head = 0; head < queue.size() && queue[head] != from; ++head) {
        for (const Assignment& wire : assignments_of(resolving, queue[head])) {
            if (!wire.wire || wire.wire->previous) continue;
            const int source = source_of(net, wire);
            if (source < 0 || seen[static_cast<std::size_t>(source)]) continue;
            if (net.instance(source).task != net.instance(from).task) continue;
            seen[static_cast<std::size_t>(source)] = true;
            next[static_cast<std::size_t>(source)] = queue[head];
            queue.push_back(source);
        }
    }
    if (!seen[static_cast<std::size_t>(from)]) return {};
    std::string path = net.instance(from).name;
    for (int at = from; at != to;) {
        at = next[static_cast<std::size_t>(at)];
        path += " -> " + net.instance(at).name;
    }
    return path + " -> " + net.instance(from).name;
}

/// In one task a wire carries this scan's value from an earlier block, and only with `previous()`
/// the last scan's from a later one or the block itself.
bool check_order(const Resolving& to, const Assignment& wire, int source) {
    const Net& net = to.net;
    const Instance& block = net.instance(wire.instance);
    const std::string& signal = wire.wire->signal;
    const bool same_task = source >= 0 && net.instance(source).task == block.task;
    const bool later = same_task && source >= wire.instance;
    if (later == wire.wire->previous) return true;
    if (wire.wire->previous && same_task) {
        to.read.diagnostics().warn(
            code::needless_previous, wire.value->mark,
            fmt::format("'{}' is scanned earlier in this task: with previous() its value comes a "
                        "scan late",
                        net.instance(source).name),
            fmt::format("write '{}' unless a delay is meant", signal));
        return true;
    }
    if (wire.wire->previous) {
        to.read.fail(
            code::needless_previous, *wire.value,
            fmt::format("'{}' needs no previous(): it comes from outside of this task", signal),
            fmt::format("did you mean '{}'?", signal));
        return false;
    }
    const std::string path = loop(to, wire.instance, source);
    if (!path.empty())
        to.read.fail(code::feedback_without_previous, *wire.value,
                     fmt::format("this feedback needs previous(): {}", path),
                     fmt::format("write previous({}) where the loop may be a scan late", signal));
    else
        to.read.fail(code::feedback_without_previous, *wire.value,
                     fmt::format("'{}' is scanned after '{}': its value of this scan is not ready",
                                 net.instance(source).name, block.name),
                     fmt::format("move it before '{}', or write previous({})", block.name, signal));
    return false;
}

/// Whether `source` may be wired at all.
bool check_source(const Resolving& to, const Assignment& wire, const Signal& source) {
    if (source.port.instance < 0) return true;
    const Direction direction = to.net.field(source.port).direction;
    if (direction == Direction::output) return true;
    to.read.fail(code::unknown_port, *wire.value,
                 fmt::format("'{}' is {} {}, not an output", source.name,
                             direction == Direction::input ? "an" : "a", name_of(direction)),
                 "a wire comes from an output");
    return false;
}

bool check_type(const Resolving& to, const Assignment& wire, const Signal& source) {
    const auto& [number, field, value, text] = wire;
    const bool is_real = field->type == Type::real;
    if (text->negated && source.type != Type::boolean) {
        to.read.fail(
            code::not_of_no_boolean, *value,
            fmt::format("NOT is for booleans, '{}' is {}", source.name, name_of(source.type)));
        return false;
    }
    const bool narrows = source.type == Type::real && is_integer(field->type);
    const bool fits = source.type == field->type ||
                      (is_integer(source.type) && (is_integer(field->type) || is_real));
    if (fits && source.names.fits(field->names)) return true;
    to.read.fail(
        code::wire_between_types, *value,
        fmt::format("'{}' is {}, '{}' takes {}", source.name, kind(source.type, source.names),
                    field->name, kind(field->type, field->names)),
        narrows ? "a block converts it: see 'lineshaft explain L0401'" : "");
    return false;
}

bool check_unit(const Resolving& to, const Assignment& wire, const Signal& source,
                const Unit& given, const Unit& wanted) {
    const bool whole = is_integer(wire.field->type) && given.text != wanted.text;
    if (given.same_dimension(wanted) && !whole) return true;
    const bool lacks_unit = source.port.instance < 0 && given.text.empty();
    to.read.fail(code::wire_between_dimensions, *wire.value,
                 fmt::format("'{}' is in {}, '{}' takes {}", source.name,
                             given.text.empty() ? "plain numbers" : given.text, wire.field->name,
                             wanted.text.empty() ? "plain numbers" : wanted.text),
                 lacks_unit ? fmt::format("give the input its unit, {}", wanted.text) : "");
    return false;
}

/// Other blocks than those of sources report what they cannot use themselves.
void narrow(Net& net, const Signal& source, const Instance& block, const Field& field) {
    if (source.port.instance >= 0 || !net.kinds || net.kinds->find(block.type->name) != block.type)
        return;
    Field& limited = net.inputs[static_cast<std::size_t>(source.port.field)].field;
    limited.minimum = std::max(limited.minimum, field.minimum);
    limited.maximum = std::min(limited.maximum, field.maximum);
}

/// An input whose value is a name, and that no wire has said the enumeration of.
bool is_of_unknown_names(const Signal& source) {
    return source.port.instance < 0 && source.type == Type::enumeration && source.names.empty();
}

/// The first wire says it; empty where it is none, or the value is not one of it.
std::optional<Signal> named_by(Resolving& to, const Signal& source, const Field& wired) {
    const auto number = static_cast<std::size_t>(source.port.field);
    InputNode& input = to.net.inputs[number];
    if (wired.type != Type::enumeration) return {};
    input.field.names = input.signal->names = wired.names;
    Field named = input.field;
    named.name = input.signal->name;
    const auto initial = read_literal(to.read, to.program.inputs[number].second, named, Unit{});
    if (!initial) return input.signal = std::nullopt;
    input.initial = *initial;
    return input.signal;
}

void check_initial_values(Resolving& to) {
    for (std::size_t i = 0; i < to.net.inputs.size(); ++i) {
        InputNode& input = to.net.inputs[i];
        if (input.signal && is_of_unknown_names(*input.signal)) {
            const Node& value = to.program.inputs[i].second;
            to.read.fail(code::not_a_boolean, value,
                         fmt::format("'{}' is not a value of an input", value.text),
                         "write true, false or a number, or a name of the enumeration that it "
                         "feeds");
            input.signal.reset();
        }
        if (!input.signal || input.field.admits(input.initial)) continue;
        Field named = input.field;
        named.name = input.signal->name;
        read_literal(to.read, to.program.inputs[i].second, named, to.net.unit(input.signal->unit));
    }
}

void connect(Resolving& to, const Assignment& wire) {
    const auto& [number, field, value, text] = wire;
    const auto name = split_signal(text->signal);
    if (name && name->owner == "outputs")
        return to.read.fail(
            code::unknown_port, *value,
            fmt::format("'{}' is for outside; a wire comes from a block or an input", text->signal),
            "wire the signal that the output shows");
    auto source = to.net.find(to.read, *value, text->signal);
    if (source && is_of_unknown_names(*source)) source = named_by(to, *source, *field);
    if (!source) return;
    const Port target = to.net.port(number, *field);
    to.instance(wire).wired[static_cast<std::size_t>(target.field)] = true;
    if (!check_source(to, wire, *source) || !check_type(to, wire, *source)) return;
    const Unit& given = to.net.unit(source->unit);
    const Unit& wanted = to.net.unit_of(target);
    if (!check_unit(to, wire, *source, given, wanted) ||
        !check_order(to, wire, source->port.instance))
        return;
    const bool widens = is_integer(source->type) && field->type == Type::real;
    const bool same_task =
        source->port.instance >= 0 && source->task == to.net.instance(number).task;
    const bool is_delay = text->previous && source->port.instance < number;
    if (given.text == wanted.text) narrow(to.net, *source, to.net.instance(number), *field);
    to.net.wires.push_back({.from = source->port,
                            .to = target,
                            .late = is_delay         ? Late::delayed
                                    : text->previous ? Late::previous
                                    : same_task      ? Late::now
                                                     : Late::published,
                            .negated = text->negated,
                            .widens = widens ? std::optional(source->type) : std::nullopt,
                            .scaled = given.text != wanted.text,
                            .factor = given.numerator * wanted.denominator,
                            .divisor = given.denominator * wanted.numerator});
}

/// All that act on one block, and it itself, are scanned in the order of the file.
void add_reference_orders(Net& net) {
    std::map<std::pair<int, int>, std::set<int>> groups;  // by task and by the block referred to
    for (const Reference& reference : net.references) {
        const int task = net.instance(reference.from).task;
        auto& group = groups[{task, reference.to}];
        group.insert(reference.from.instance);
        if (net.instance(reference.to).task == task) group.insert(reference.to);
    }
    for (const auto& [key, group] : groups)
        for (auto at = group.begin(); std::next(at) != group.end(); ++at)
            net.orders.push_back({*at, *std::next(at)});
}

/// A slave takes what its master has just done, where that stands before it in the file.
void add_orders_of_handles(Net& net) {
    std::map<std::pair<int, const BlockType*>, int> last;  // by task and kind
    for (int i = 0; i < static_cast<int>(net.instances.size()); ++i) {
        const Instance& instance = net.instance(i);
        if (!instance.known() || instance.type->handle.empty()) continue;
        const auto [before, is_first] = last.try_emplace({instance.task, instance.type}, i);
        if (!is_first) net.orders.push_back({before->second, i, true});
        before->second = i;
    }
}

/// A block waits for its sources, and what takes its last scan's outputs comes before it.
void add_orders(Net& net) {
    for (const Wire& wire : net.wires) {
        const int source = wire.from.instance, reader = wire.to.instance;
        if (wire.late == Late::now)
            net.orders.push_back({source, reader});
        else if (wire.late == Late::previous && source != reader)
            net.orders.push_back(
                {reader, source, net.instance(source).type == net.instance(reader).type});
    }
}

}  // namespace

void resolve_wires(Resolving& to) {
    for (const Assignment& assignment : to.assignments)
        if (assignment.wire) connect(to, assignment);
    check_initial_values(to);
    add_orders(to.net);
    add_reference_orders(to.net);
    add_orders_of_handles(to.net);
}

}  // namespace lineshaft

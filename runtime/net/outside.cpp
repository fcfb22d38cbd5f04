#include "runtime/net/outside.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"

namespace lineshaft {

namespace {

std::optional<Value> read_value(const Connecting& to, const Target& target, const Node& value) {
    return read_literal(to.read, value, target.field, to.net.unit(target.signal.unit));
}

/// The field of that name that a program may set; null when there is none.
const Field* settable_field(const Net& net, const Target& target) {
    const Port port = target.signal.port;
    return net.instance(port).type->find_settable(net.field(port).name);
}

bool is_wired(const Net& net, const Target& target) {
    const Field* field = settable_field(net, target);
    if (!field) return false;
    const Port port = net.port(target.signal.port.instance, *field);
    return net.instance(port).wired[static_cast<std::size_t>(port.field)];
}

void add_stimulus(Connecting& to, const StimulusPlan& plan, int task, const Node& key,
                  const Node& value) {
    const auto set = find_settable(to, key);
    if (!set) return;
    const auto v = read_value(to, *set, value);
    if (!v) return;
    auto& list =
        task < 0 ? to.machine.stimuli : to.machine.tasks[static_cast<std::size_t>(task)].stimuli;
    list.push_back(
        {plan.at, set->live, set->field.type, *v, fmt::format("{} = {}", key.text, value.text)});
}

void add_force(Connecting& to, const ForcePlan& plan) {
    const auto forced = find_target(to, plan.signal);
    if (!forced) return;
    const std::string& name = forced->signal.name;
    if (forced->field.direction == Direction::parameter)
        return to.read.fail("L0405", plan.signal,
                            fmt::format("'{}' is a parameter and cannot be forced", name),
                            "a force takes inputs and outputs");
    const auto value = read_value(to, *forced, plan.value);
    if (!value) return;
    auto& forces = to.machine.forces;
    const auto overlaps = [&](const Force& other) {
        return other.live == forced->live && plan.from < other.until && other.from < plan.until;
    };
    if (std::ranges::any_of(forces, overlaps))
        return to.read.fail("L0212", plan.signal,
                            fmt::format("'{}' is forced twice at one time", name));
    const std::byte* of_block =
        forced->is_of_block()
            ? to.machine.blocks[static_cast<std::size_t>(forced->signal.port.instance)].live
            : nullptr;
    const bool split = forced->published != forced->live;
    forces.push_back({.from = plan.from,
                      .until = plan.until,
                      .live = forced->live,
                      .published = split ? forced->published : nullptr,
                      .block = of_block,
                      .is_output = of_block && forced->field.direction != Direction::input,
                      .task = forced->signal.task,
                      .type = forced->field.type,
                      .value = *value,
                      .name = name,
                      .text = fmt::format("force {} = {}", name, plan.value.text)});
}

}  // namespace

std::optional<Target> find_target(const Connecting& to, const Node& node) {
    auto found = to.net.find(to.read, node, node.text);
    if (!found) return {};
    const Port port = found->port;
    if (port.instance >= 0) found = to.net.signal(port);
    Target target{.signal = to.machine.placed(std::move(*found)),
                  .live = to.machine.live(port),
                  .published = to.machine.published(port)};
    if (target.is_of_block()) {
        target.field = to.net.field(port);
    } else {
        target.field.type = target.signal.type;
        target.field.direction = Direction::input;
    }
    target.field.name = node.text;
    return target;
}

std::optional<Target> find_settable(const Connecting& to, const Node& node) {
    auto target = find_target(to, node);
    if (!target || !target->is_of_block()) return target;
    if (is_wired(to.net, *target)) {
        to.read.fail("L0409", node,
                     fmt::format("'{}' is wired and cannot be set", target->signal.name),
                     "wire an input of the program (inputs.name) and set that, or force it");
        return {};
    }
    const Field* field = settable_field(to.net, *target);
    const Direction direction = to.net.field(target->signal.port).direction;
    if (!field || field->direction == Direction::parameter) {
        to.read.fail("L0405", node,
                     fmt::format("'{}' is {} and cannot be set", target->signal.name,
                                 field                            ? "a parameter"
                                 : direction == Direction::output ? "an output"
                                                                  : "a local"),
                     field ? "a stimulus sets inputs"
                           : "a stimulus sets inputs; a force takes outputs, too");
        return {};
    }
    const Port port = to.net.port(target->signal.port.instance, *field);
    target->field = *field;
    target->live = to.machine.live(port);
    target->signal.unit = to.net.unit_of(port).text;
    return target;
}

void connect_stimuli(Connecting& to) {
    for (const StimulusPlan& plan : to.program.stimuli) {
        const int task = plan.task ? to.net.find_task(to.read, *plan.task, plan.task->text) : -1;
        if (plan.task && task < 0) continue;
        for (const auto& [key, value] : plan.set) add_stimulus(to, plan, task, key, value);
    }
}

void connect_forces(Connecting& to) {
    for (const ForcePlan& plan : to.program.forces) add_force(to, plan);
}

void connect_outside(Connecting& to) {
    connect_events(to);
    connect_run(to);
    connect_stimuli(to);
    connect_replays(to);
    connect_forces(to);
    connect_retained(to);
    check_constants(to);
    warn_of_what_comes_late(to);
}

}  // namespace lineshaft

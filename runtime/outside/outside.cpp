#include "runtime/outside/outside.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

/// The field of that name that a program may set; null when there is none.
const Field* settable_field(const Net& net, const Target& target) {
    const Port port = target.signal.port;
    return net.instance(port).type->find_settable(net.field(port).name);
}

/// An output whose block reads what others write there.
bool is_set_where_read(const Net& net, const Target& target) {
    const Field* field = settable_field(net, target);
    return field && target.field.direction == Direction::output &&
           field->offset == target.field.offset;
}

bool is_wired(const Net& net, const Target& target) {
    const Field* field = settable_field(net, target);
    if (!field) return false;
    const Port port = net.port(target.signal.port.instance, *field);
    return net.instance(port).wired[static_cast<std::size_t>(port.field)];
}

void add_force(Connecting& to, const ForcePlan& plan) {
    auto force = find_force(to, plan.signal, plan.value);
    if (!force) return;
    force->from = plan.from;
    force->until = plan.until;
    const auto overlaps = [&](const Force& other) {
        return other.live == force->live && plan.from < other.until && other.from < plan.until;
    };
    if (std::ranges::any_of(to.machine.forces, overlaps))
        return to.read.fail(code::named_twice, plan.signal,
                            fmt::format("'{}' is forced twice at one time", force->name));
    to.machine.forces.push_back(std::move(*force));
}

void add_recorded(Connecting& to, const RecordedPlan& plan) {
    for (const auto& [signal, value] : plan.set)
        if (auto stimulus = find_stimulus(to, signal, value)) {
            stimulus->at = plan.at;
            to.machine.stimuli.push_back(std::move(*stimulus));
        }
    for (const auto& [signal, value] : plan.force)
        if (auto force = find_force(to, signal, value)) {
            force->from = plan.at;
            to.machine.impose(std::move(*force));
        }
    for (const Node& signal : plan.lift_force)
        if (const auto target = find_target(to, signal))
            to.machine.lift_force(target->live, plan.at);
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
        target.field = to.net.inputs[static_cast<std::size_t>(port.field)].field;
    }
    if (target.is_of_block() && is_set_where_read(to.net, target))
        target.field.direction = Direction::local;
    target.field.name = node.text;
    return target;
}

std::optional<Target> find_settable(const Connecting& to, const Node& node) {
    auto target = find_target(to, node);
    if (!target || !target->is_of_block()) return target;
    if (is_wired(to.net, *target)) {
        to.read.fail(code::stimulus_on_wired_input, node,
                     fmt::format("'{}' is wired and cannot be set", target->signal.name),
                     "wire an input of the program (inputs.name) and set that, or force it");
        return {};
    }
    const Field* field = settable_field(to.net, *target);
    const Direction direction = to.net.field(target->signal.port).direction;
    if (!field || field->direction == Direction::parameter) {
        to.read.fail(code::port_cannot_be_set, node,
                     fmt::format("'{}' is {} and cannot be set", target->signal.name,
                                 field                            ? "a parameter"
                                 : direction == Direction::output ? "an output"
                                                                  : "a local"),
                     field ? "a stimulus sets inputs"
                           : "a stimulus sets inputs; a force takes outputs and locals, too");
        return {};
    }
    const Port port = to.net.port(target->signal.port.instance, *field);
    target->field = *field;
    target->live = to.machine.live(port);
    target->signal.unit = to.net.unit_of(port).text;
    return target;
}

std::optional<Value> read_value(const Connecting& to, const Target& target, const Node& value) {
    return read_literal(to.read, value, target.field, to.net.unit(target.signal.unit));
}

Stimulus stimulus_of(const Target& target, const Value& value, std::string_view name,
                     std::string_view text) {
    return {.target = target.live,
            .type = target.field.type,
            .value = value,
            .text = fmt::format("{} = {}", name, text)};
}

std::optional<Stimulus> find_stimulus(const Connecting& to, const Node& signal, const Node& value) {
    const auto target = find_settable(to, signal);
    const auto v = target ? read_value(to, *target, value) : std::nullopt;
    if (!v) return {};
    return stimulus_of(*target, *v, signal.text, value.text);
}

std::optional<Target> find_forceable(const Connecting& to, const Node& signal) {
    auto target = find_target(to, signal);
    if (!target || target->field.direction != Direction::parameter) return target;
    to.read.fail(code::port_cannot_be_set, signal,
                 fmt::format("'{}' is a parameter and cannot be forced", target->signal.name),
                 "a force takes inputs, outputs and locals");
    return {};
}

Force force_of(const Machine& machine, const Target& target, const Value& value, std::string text) {
    const BlockPlace* place =
        target.is_of_block()
            ? &machine.blocks[static_cast<std::size_t>(target.signal.port.instance)]
            : nullptr;
    const bool is_output = place && target.field.direction != Direction::input;
    const bool is_of_program = place && place->type->owner;
    const bool split = target.published != target.live;
    return {.live = target.live,
            .published = split ? target.published : nullptr,
            .block = place ? place->live : nullptr,
            .is_output = is_output,
            .stays = is_output && (is_of_program || target.field.direction == Direction::local),
            .task = target.signal.task,
            .type = target.field.type,
            .value = value,
            .name = target.signal.name,
            .value_text = std::move(text)};
}

std::optional<Force> find_force(const Connecting& to, const Node& signal, const Node& value) {
    const auto target = find_forceable(to, signal);
    const auto v = target ? read_value(to, *target, value) : std::nullopt;
    if (!v) return {};
    return force_of(to.machine, *target, *v, value.text);
}

static void connect_stimuli(Connecting& to) {
    for (const StimulusPlan& plan : to.program.stimuli) {
        const int task = plan.task ? to.net.find_task(to.read, *plan.task, plan.task->text) : -1;
        if (plan.task && task < 0) continue;
        auto& list = task < 0 ? to.machine.stimuli
                              : to.machine.tasks[static_cast<std::size_t>(task)].stimuli;
        for (const auto& [key, value] : plan.set)
            if (auto stimulus = find_stimulus(to, key, value)) {
                stimulus->at = plan.at;
                list.push_back(std::move(*stimulus));
            }
    }
}

static void connect_forces(Connecting& to) {
    for (const ForcePlan& plan : to.program.forces) add_force(to, plan);
}

/// The recording's end is the run's, whatever the program says of it.
static void connect_recorded(Connecting& to) {
    if (!to.program.recording) return;
    const auto& entries = to.program.recording->entries;
    to.machine.stimuli.reserve(to.machine.stimuli.size() + entries.size());
    for (const RecordedPlan& plan : entries) add_recorded(to, plan);
    std::ranges::stable_sort(to.machine.stimuli, {}, &Stimulus::at);
    to.machine.duration = never - 1;
    to.machine.end = to.program.recording->end();
}

void connect_outside(Connecting& to) {
    connect_events(to);
    connect_run(to);
    connect_stimuli(to);
    connect_replays(to);
    connect_forces(to);
    connect_recorded(to);
    connect_retained(to);
    check_constants(to);
    warn_of_what_comes_late(to);
}

}  // namespace lineshaft

#include <algorithm>

#include <fmt/format.h>

#include "runtime/outside/outside.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

/// A boolean signal, or reported: `what` takes one.
std::optional<Signal> find_boolean(Connecting& to, const Node& node, const char* what) {
    const auto found = to.net.find(to.read, node, node.text);
    if (!found) return {};
    if (found->type == Type::boolean) return to.machine.placed(*found);
    to.read.fail(
        code::wire_between_types, node,
        fmt::format("'{}' takes a boolean, '{}' is {}", what, found->name, name_of(found->type)));
    return {};
}

}  // namespace

void connect_events(Connecting& to) {
    for (const TaskPlan& plan : to.program.tasks) {
        const auto it = std::ranges::find(to.net.tasks, plan.name, &TaskSettings::name);
        for (const Node& node : plan.on)
            if (const auto event = find_boolean(to, node, "on"))
                to.machine.triggers.push_back(
                    {.signal = reinterpret_cast<const bool*>(event->slot),
                     .task = static_cast<int>(it - to.net.tasks.begin())});
    }
}

void connect_run(Connecting& to) {
    Machine& machine = to.machine;
    const RunPlan& run = to.program.run;
    machine.duration = run.duration;
    machine.seed = run.seed;
    machine.continue_on_error = run.continue_on_error;
    if (run.until) machine.until = find_boolean(to, *run.until, "until");
    if (machine.devices.empty()) return;
    for (const ExpectPlan& plan : to.program.expectations)
        if (plan.when == ExpectPlan::When::at || plan.from > 0) machine.looks.push_back(plan.from);
    std::ranges::sort(machine.looks);
}

}  // namespace lineshaft

#include <algorithm>

#include <fmt/format.h>

#include "runtime/net/linker.hpp"

namespace lineshaft {

namespace {

constexpr std::uint64_t most_memory = std::uint64_t{256} << 20;  // bytes, of all traces

}  // namespace

void Linker::connect_traces() {
    std::uint64_t memory = 0;
    for (const TracePlan& plan : program_.traces) {
        out_.traces.push_back(connect_trace(plan));
        const std::uint64_t own = out_.traces.back().memory();
        memory += std::min(own, 2 * most_memory);
        if (plan.pre_trigger == 0 || memory <= most_memory) continue;
        read_.fail("L0215", plan.ring,
                   fmt::format("{} rows before the trigger take {} MiB, and all traces may take {}",
                               plan.pre_trigger, own >> 20, most_memory >> 20),
                   "keep fewer rows or signals, or record every n-th scan only");
        return;
    }
}

TraceSetup Linker::connect_trace(const TracePlan& plan) {
    TraceSetup setup{.name = plan.name.text,
                     .every = plan.every,
                     .signals = {},
                     .pre_trigger = plan.pre_trigger,
                     .samples = plan.samples,
                     .duration = plan.duration,
                     .repeat = plan.repeat};
    const auto it = std::ranges::find(task_names_, plan.task.text);
    if (it != task_names_.end())
        setup.task = static_cast<int>(it - task_names_.begin());
    else if (!plan.task.text.empty() && program_.tasks_known)
        read_.fail("L0206", plan.task, fmt::format("unknown task '{}'", plan.task.text),
                   suggest(plan.task.text, task_names_));
    for (const Node& node : plan.signals)
        if (auto s = signal(node)) setup.signals.push_back(std::move(*s));
    if (plan.trigger.kind != TriggerKind::immediate) setup.trigger = connect_trigger(plan.trigger);
    return setup;
}

TraceTrigger Linker::connect_trigger(const TriggerPlan& plan) {
    using enum TriggerKind;
    TraceTrigger trigger{.kind = plan.kind};
    const auto watched = signal(plan.signal);
    if (!watched) return trigger;
    trigger.signal = *watched;
    const bool of_edge = plan.kind == rising || plan.kind == falling;
    const bool is_number = watched->type == Type::real || watched->type == Type::integer;
    if (of_edge ? watched->type != Type::boolean : !is_number && plan.kind != equals)
        read_.fail("L0401", plan.signal,
                   fmt::format("{} takes a {}, '{}' is {}", of_edge ? "an edge" : "a bound",
                               of_edge ? "boolean" : "number", watched->name,
                               kind(watched->type, watched->names)),
                   of_edge ? "numbers have above, below, inside and equals"
                           : "booleans have edge: rising and edge: falling");
    else if (!plan.values.empty()) {
        trigger.low = trigger.high = bound(*watched, plan.values.front()).value_or(0.0);
        if (plan.values.size() > 1)
            trigger.high = bound(*watched, plan.values.back()).value_or(0.0);
        if (compare(trigger.low, trigger.high) > 0)
            read_.fail("L0213", plan.values.front(), "the lower bound is above the upper one");
    }
    return trigger;
}

}  // namespace lineshaft

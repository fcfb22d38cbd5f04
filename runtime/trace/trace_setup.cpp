#include "runtime/trace/trace_setup.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/scan/expectations.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

constexpr std::uint64_t most_memory = std::uint64_t{256} << 20;  // bytes, of all traces

TraceTrigger connect_trigger(const Connecting& to, const TriggerPlan& plan) {
    using enum TriggerKind;
    TraceTrigger trigger{.kind = plan.kind};
    const auto watched = to.net.find(to.read, plan.signal, plan.signal.text);
    if (!watched) return trigger;
    trigger.signal = to.machine.placed(*watched);
    const bool of_edge = plan.kind == rising || plan.kind == falling;
    const bool is_number = watched->type == Type::real || is_integer(watched->type);
    if (of_edge ? watched->type != Type::boolean : !is_number && plan.kind != equals)
        to.read.fail(code::wire_between_types, plan.signal,
                     fmt::format("{} takes a {}, '{}' is {}", of_edge ? "an edge" : "a bound",
                                 of_edge ? "boolean" : "number", watched->name,
                                 kind(watched->type, watched->names)),
                     of_edge ? "numbers have above, below, inside and equals"
                             : "booleans have edge: rising and edge: falling");
    else if (!plan.values.empty()) {
        trigger.low = trigger.high = read_bound(to, *watched, plan.values.front()).value_or(0.0);
        if (plan.values.size() > 1)
            trigger.high = read_bound(to, *watched, plan.values.back()).value_or(0.0);
        if (compare(trigger.low, trigger.high) > 0)
            to.read.fail(code::entries_do_not_go_together, plan.values.front(),
                         "the lower bound is above the upper one");
    }
    return trigger;
}

TraceSetup connect_trace(const Connecting& to, const TracePlan& plan) {
    TraceSetup setup{.name = plan.name.text,
                     .every = plan.every,
                     .signals = {},
                     .pre_trigger = plan.pre_trigger,
                     .samples = plan.samples,
                     .duration = plan.duration,
                     .repeat = plan.repeat};
    setup.task = std::max(0, to.net.find_task(to.read, plan.task, plan.task.text));
    for (const Node& node : plan.signals)
        if (auto s = to.net.find(to.read, node, node.text))
            setup.signals.push_back(to.machine.placed(std::move(*s)));
    if (plan.trigger.kind != TriggerKind::immediate && plan.trigger.signal.mark.line > 0)
        setup.trigger = connect_trigger(to, plan.trigger);
    return setup;
}

}  // namespace

std::vector<TraceSetup> connect_traces(const Connecting& to) {
    std::vector<TraceSetup> traces;
    std::uint64_t memory = 0;
    for (const TracePlan& plan : to.program.traces) {
        traces.push_back(connect_trace(to, plan));
        const std::uint64_t own = traces.back().memory();
        memory += std::min(own, 2 * most_memory);
        if (plan.pre_trigger == 0 || memory <= most_memory) continue;
        to.read.fail(
            code::too_many_rows_kept, plan.ring,
            fmt::format("{} rows before the trigger take {} MiB, and all traces may take {}",
                        plan.pre_trigger, own >> 20, most_memory >> 20),
            "keep fewer rows or signals, or record every n-th scan only");
        break;
    }
    return traces;
}

}  // namespace lineshaft

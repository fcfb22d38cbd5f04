#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "runtime/names/resolve.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

/// What the main task has in Siemens' controllers [ns].
constexpr std::int64_t default_maximum_cycle_time = 150'000'000;

TaskSettings settings_of(const TaskPlan& plan) {
    TaskSettings task;
    task.name = plan.name;
    task.on_event = plan.every == 0;
    task.once = plan.once;
    task.motion = plan.motion;
    task.maximum_cycle_time = plan.maximum_cycle_time.value_or(never);
    task.every = plan.every;
    task.offset = plan.offset;
    task.priority = plan.once ? std::numeric_limits<std::int64_t>::max() : plan.priority;
    task.jitter = plan.jitter;
    task.cost = plan.cost;
    task.cost_jitter = plan.cost_jitter;
    return task;
}

void add_costs(Resolving& to) {
    for (const StimulusPlan& plan : to.program.stimuli) {
        if (!plan.task || !plan.cost) continue;
        const int task = to.net.find_task(to.read, *plan.task, plan.task->text);
        if (task < 0) continue;
        auto& costs = to.net.tasks[static_cast<std::size_t>(task)].costs;
        if (!costs.empty() && costs.back().scan == plan.at)
            to.read.fail(
                code::named_twice, *plan.task,
                fmt::format("scan {} of '{}' has a cost already", plan.at, plan.task->text));
        costs.push_back({plan.at, *plan.cost});
    }
}

void add_overrun(Resolving& to, int handler, const Node& node) {
    const int index = to.net.find_task(to.read, node, node.text);
    if (index < 0) return;
    TaskSettings& task = to.net.tasks[static_cast<std::size_t>(index)];
    if (task.motion || index == handler)
        to.read.fail(code::time_error_without_task, node,
                     fmt::format("'{}' {}", node.text,
                                 task.motion ? "is a motion task: its overrun is STOP"
                                             : "cannot handle its own overrun"));
    else if (task.on_overrun >= 0)
        to.read.fail(code::named_twice, node,
                     fmt::format("the overrun of '{}' starts '{}' already", node.text,
                                 to.net.tasks[static_cast<std::size_t>(task.on_overrun)].name));
    else
        task.on_overrun = handler;
}

}  // namespace

void resolve_tasks(Resolving& to) {
    auto& tasks = to.net.tasks;
    to.net.tasks_known = to.program.tasks_known;
    for (const TaskPlan& plan : to.program.tasks) tasks.push_back(settings_of(plan));
    std::ranges::stable_sort(tasks, std::ranges::greater{}, &TaskSettings::priority);
    const auto is_cyclic = [](const TaskSettings& task) { return !task.on_event; };
    const auto main = std::find_if(tasks.rbegin(), tasks.rend(), is_cyclic);
    if (main != tasks.rend()) {
        to.net.main_task = static_cast<int>(tasks.rend() - main) - 1;
        if (main->maximum_cycle_time == never)
            main->maximum_cycle_time = default_maximum_cycle_time;
    }
    add_costs(to);
    for (const TaskPlan& plan : to.program.tasks) {
        const auto handler = std::ranges::find(tasks, plan.name, &TaskSettings::name);
        for (const Node& node : plan.on_overrun)
            add_overrun(to, static_cast<int>(handler - tasks.begin()), node);
    }
}

}  // namespace lineshaft

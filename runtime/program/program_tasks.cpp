#include <algorithm>

#include <fmt/format.h>

#include "runtime/program/program_reader.hpp"

namespace lineshaft {

void ProgramReader::tasks(const Node& node) {
    if (read_.expect_map(node, "'tasks'") && node.entries.empty())
        read_.fail("L0202", node, "'tasks' has no task", task_help);
    if (node.entries.empty()) program_.tasks_known = false;
    for (const auto& [name, body] : node.entries) {
        if (read_.identifier(name, "a task") && read_.expect_map(body, "a task"))
            task(name, body);
        else
            program_.tasks_known = false;
    }
}

void ProgramReader::task(const Node& name, const Node& body) {
    read_.only_keys(body, fmt::format("task '{}'", name.text),
                    {"every", "on", "on_overrun", "offset", "priority", "jitter", "cost",
                     "cost_jitter", "maximum_cycle_time", "motion"});
    auto plan = std::ranges::find(program_.tasks, name.text, &TaskPlan::name);
    if (plan == program_.tasks.end())
        plan = program_.tasks.insert(plan, {.name = name.text, .mark = name.mark, .on = {}});
    plan->unattached =
        in_controller_ && !body.find("on") && !body.find("every") && !body.find("on_overrun");
    if (const Node* on = body.find("on"))
        events(*plan, *on, body);
    else if (const Node* overrun = body.find("on_overrun"))
        overruns(*plan, *overrun, body);
    else
        interval(*plan, name, body);
    if (const Node* n = body.find("cost")) plan->cost = read_.time(*n).value_or(plan->cost);
    if (const Node* n = body.find("cost_jitter"))
        plan->cost_jitter = read_.time_or_share(*n, plan->cost).value_or(plan->cost_jitter);
    if (const Node* n = body.find("priority"))
        plan->priority = read_.integer(*n).value_or(plan->priority);
    if (const Node* n = body.find("maximum_cycle_time")) {
        plan->maximum_cycle_time = read_.time(*n);
        if (plan->maximum_cycle_time == 0)
            read_.fail("L0308", *n, "a maximum cycle time must be above 0");
    }
    if (const Node* n = body.find("motion"))
        plan->motion = read_.boolean(*n).value_or(plan->motion);
    check_task(*plan, name, body);
}

/// Parts of it may come from the controller's file: then the name is the place.
void ProgramReader::check_task(const TaskPlan& plan, const Node& name, const Node& body) {
    const auto fail = [&](std::initializer_list<const char*> keys, std::string_view what) {
        const Node* place = nullptr;
        for (const char* key : keys)
            if (!place) place = body.find(key);
        read_.fail("L0305", place ? *place : name, fmt::format(fmt::runtime(what), name.text));
    };
    if (plan.every > 0 && plan.jitter >= plan.every)
        fail({"jitter", "every"}, "the jitter of task '{}' is not below its interval");
    if (plan.cost_jitter > plan.cost)
        fail({"cost_jitter", "cost"}, "the cost_jitter of task '{}' is above its cost");
    if (plan.every > 0 && plan.cost - plan.cost_jitter > plan.every)
        fail({"cost", "every"},
             "the cost of task '{}' is above its interval: it never ends in time");
}

void ProgramReader::check_attached(const Node& task) {
    const auto plan = std::ranges::find(program_.tasks, task.text, &TaskPlan::name);
    if (plan == program_.tasks.end() || !plan->unattached) return;
    read_.fail(
        "L0202", task,
        fmt::format("the controller's task '{}' never runs: nothing starts it", task.text),
        fmt::format("attach it to an event: tasks: {{{}: {{on: inputs.start}}}}", task.text));
}

void ProgramReader::interval(TaskPlan& plan, const Node& name, const Node& body) {
    const Node* every = body.find("every");
    if (!every && plan.every == 0 && plan.on.empty() && plan.on_overrun.empty() && !plan.unattached)
        read_.fail("L0202", name, fmt::format("task '{}' has no 'every' and no 'on'", name.text),
                   "write its interval, such as every: 2 ms, or the event that starts it, such as "
                   "on: inputs.start or on_overrun: main");
    if (every) {
        plan.on.clear();
        plan.on_overrun.clear();
    }
    if (every) plan.every = read_.time(*every).value_or(plan.every);
    if (every && plan.every == 0 && read_.time(*every))
        read_.fail("L0308", *every, "a task's interval must be above 0");
    if (const Node* n = body.find("offset")) plan.offset = read_.time(*n).value_or(plan.offset);
    if (const Node* n = body.find("jitter"))
        plan.jitter = read_.time_or_share(*n, plan.every).value_or(plan.jitter);
}

void ProgramReader::events(TaskPlan& plan, const Node& on, const Node& body) {
    plan.on.clear();
    plan.on_overrun.clear();
    plan.every = plan.offset = plan.jitter = 0;
    if (on.is_sequence())
        plan.on = on.items;
    else
        plan.on.push_back(on);
    if (plan.on.empty()) read_.fail("L0202", on, "'on' names no signal");
    for (const Node& signal : plan.on)
        if (!read_.expect_scalar(signal, "a signal")) return plan.on.clear();
    no_interval(body, "on");
}

void ProgramReader::overruns(TaskPlan& plan, const Node& on, const Node& body) {
    plan.on.clear();
    plan.every = plan.offset = plan.jitter = 0;
    plan.on_overrun = on.is_sequence() ? on.items : std::vector<Node>{on};
    if (plan.on_overrun.empty()) read_.fail("L0202", on, "'on_overrun' names no task");
    for (const Node& task : plan.on_overrun)
        if (!read_.expect_scalar(task, "a task's name")) return plan.on_overrun.clear();
    no_interval(body, "on_overrun");
}

void ProgramReader::no_interval(const Node& body, std::string_view key) {
    for (const char* other : {"every", "offset", "jitter", "on_overrun"})
        if (const Node* n = body.find(other); n && key != other)
            read_.fail("L0213", *n, fmt::format("a task says '{}' or '{}', not both", key, other),
                       "an event task has no interval");
}

}  // namespace lineshaft

#include <algorithm>

#include <fmt/format.h>

#include "runtime/program/program.hpp"
#include "runtime/program/program_parts.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

using enum Rule::Kind;
using enum Rule::Place;

void read_jitter(const Reader& read, const Node& node, TaskPlan& task) {
    task.jitter = read.time_or_share(node, task.every).value_or(task.jitter);
}

void read_cost_jitter(const Reader& read, const Node& node, TaskPlan& task) {
    task.cost_jitter = read.time_or_share(node, task.cost).value_or(task.cost_jitter);
}

/// Parts of it may come from the controller's file: then the name is the place.
void check_times(const Reader& read, const Node& body, const TaskPlan& task) {
    const auto fail = [&](std::initializer_list<const char*> keys, std::string_view what) {
        Node place;
        place.mark = task.mark;
        for (const char* key : keys)
            if (const Node* node = body.find(key); node && place.text.empty()) place = *node;
        read.fail(code::number_out_of_range, place, fmt::format(fmt::runtime(what), task.name));
    };
    if (task.every > 0 && task.jitter >= task.every)
        fail({"jitter", "every"}, "the jitter of task '{}' is not below its interval");
    if (task.cost_jitter > task.cost)
        fail({"cost_jitter", "cost"}, "the cost_jitter of task '{}' is above its cost");
    if (task.every > 0 && task.cost - task.cost_jitter > task.every)
        fail({"cost", "every"},
             "the cost of task '{}' is above its interval: it never ends in time");
}

/// What starts the task is said once; what is said last replaces what its controller says.
void check_task(const Reader& read, const Node& body, TaskPlan& task) {
    const bool on = body.find("on"), overrun = body.find("on_overrun"), every = body.find("every");
    const bool once = body.find("once") && task.once;
    if (on || overrun || once) task.every = task.offset = task.jitter = 0;
    if (every || once || (overrun && !on)) task.on.clear();
    if (every || on || once) task.on_overrun.clear();
    if (every || on || overrun) task.once = false;
    const bool said = on || overrun || every || once;
    if (said) task.unattached = false;
    if (!said && task.every == 0 && task.on.empty() && task.on_overrun.empty() && !task.once &&
        !task.unattached)
        read.diagnostics().add(
            code::entry_is_missing, task.mark,
            fmt::format("task '{}' has no 'every' and no 'on'", task.name),
            "write its interval, such as every: 2 ms, or the event that starts it, such as "
            "on: inputs.start or on_overrun: main");
    check_times(read, body, task);
}

constexpr const char* no_interval = "an event task has no interval";
constexpr const char* no_other_start = "a task that runs once comes before all others";

template <st::OpClass of>
void read_time(const Reader& read, const Node& node, st::InstructionTimes& times) {
    times[static_cast<std::size_t>(of)] = read.time(node).value_or(0);
}

}  // namespace

const Form& task_form() {
    static const Form form = form_of<TaskPlan>(
        {.name = "task",
         .what = "a task",
         .doc = "scans its blocks, cyclically or at events; in a program it may change a task of "
                "the controller",
         .keys =
             {key<&TaskPlan::every>("every", a_time.above_zero("a task's interval must be above 0"),
                                    "interval"),
              key<&TaskPlan::on>(
                  "on", one_or_list(a_signal, "'on' names no signal"),
                  "boolean signals: each rising edge starts a scan, a pulse output's at its exact "
                  "time; one that "
                  "comes while the task runs is remembered, a second one is a time error"),
              key<&TaskPlan::on_overrun>("on_overrun",
                                         one_or_list(a_task, "'on_overrun' names no task"),
                                         "tasks: each of their time errors starts a scan, as OB80"),
              key<&TaskPlan::once>("once", a_boolean,
                                   "one scan, before the first of any other task, as OB100")
                  .by_default("false"),
              key<&TaskPlan::offset>("offset", a_time, "start of the first scan").by_default("0 s"),
              key<&TaskPlan::priority>("priority", an_integer, "a larger number wins")
                  .by_default("1"),
              key<read_jitter>("jitter", a_time_or_share,
                               "each interval is drawn from every +- jitter, below the interval")
                  .by_default("0 s"),
              key<&TaskPlan::cost>(
                  "cost", a_time,
                  "execution time: outputs are published that much after the start, and a task of "
                  "higher priority interrupts")
                  .by_default("0 s"),
              key<read_cost_jitter>("cost_jitter", a_time_or_share,
                                    "each cost is drawn from cost +- cost_jitter, at most the cost")
                  .by_default("0 s"),
              key<&TaskPlan::maximum_cycle_time>(
                  "maximum_cycle_time", a_time.above_zero("a maximum cycle time must be above 0"),
                  "a scan that lasts longer, interruptions included, is a time error; 150 ms in "
                  "the cyclic task of "
                  "lowest priority unless said"),
              key<&TaskPlan::motion>("motion", a_boolean,
                                     "a time error stops the run with exit 3, as of MC_Servo")
                  .by_default("false")},
         .rules =
             {{not_with,
               "on",
               {"every", "offset", "jitter", "on_overrun"},
               {},
               no_interval,
               the_other},
              {not_with,
               "once",
               {"every", "on", "on_overrun", "offset", "priority", "jitter"},
               {},
               no_other_start,
               the_other},
              {not_with, "on_overrun", {"every", "offset", "jitter"}, {}, no_interval, the_other}},
         .check = by<check_task>});
    return form;
}

namespace {

void read_task(const Reader& read, const Node& name, const Node& body, bool in_controller,
               Program& program) {
    if (!read.identifier(name, "a task") || !read.expect_map(body, "a task")) return;
    auto task = std::ranges::find(program.tasks, name.text, &TaskPlan::name);
    if (task == program.tasks.end())
        task = program.tasks.insert(task, {.name = name.text, .mark = name.mark, .on = {}});
    task->unattached = in_controller;
    TaskPlan& plan = *task;
    const Mark first = std::exchange(plan.mark, name.mark);
    read_form(task_form(), read, body, plan, fmt::format("task '{}'", name.text));
    plan.mark = first;
}

}  // namespace

void read_tasks(const Reader& read, const Node& node, Program& program) {
    for (const auto& [name, body] : node.entries) read_task(read, name, body, false, program);
}

void read_controller_tasks(const Reader& read, const Node& node, Program& program) {
    for (const auto& [name, body] : node.entries) read_task(read, name, body, true, program);
}

const Form& instruction_time_form() {
    using enum st::OpClass;
    static const Form form = form_of<st::InstructionTimes>(
        {.name = "instruction_time",
         .what = "'instruction_time'",
         .doc =
             "what an instruction of Structured Text takes. A scan's execution time is then what "
             "its task's cost says, and what the code that it executes takes",
         .keys = {key<read_time<boolean>>("bool", a_time, "AND, OR, NOT, shifts, bits of words")
                      .by_default("0 s"),
                  key<read_time<integer>>(
                      "integer", a_time,
                      "arithmetic and comparisons of whole numbers and times, an array's index")
                      .by_default("0 s"),
                  key<read_time<real>>("real", a_time, "arithmetic, comparisons and functions")
                      .by_default("0 s"),
                  key<read_time<text>>("text", a_time, "functions of a STRING").by_default("0 s"),
                  key<read_time<move>>("move", a_time, "an assignment, also of a structure")
                      .by_default("0 s"),
                  key<read_time<jump>>("jump", a_time, "to another place: IF, CASE, loops, RETURN")
                      .by_default("0 s"),
                  key<read_time<call>>("call", a_time, "of a function or a function block")
                      .by_default("0 s")},
         .rules = {{at_least_one,
                    {},
                    {"bool", "integer", "real", "text", "move", "jump", "call"},
                    "'instruction_time' says no time",
                    "write one, such as {real: 12 ns}, or leave it out"}}});
    return form;
}

void read_instruction_time(const Reader& read, const Node& node, Program& program) {
    if (read.expect_map(node, "'instruction_time'"))
        read_form(instruction_time_form(), read, node, program.instruction_times.emplace());
}

}  // namespace lineshaft

#include "tools/lineshaft/new_tasks.hpp"

#include <algorithm>
#include <initializer_list>
#include <set>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"

namespace lineshaft {

namespace {

/// One for OB1 and its like, one for each cyclic interrupt, with the interval that TIA Portal gives
/// a new one and the priority of its number, one for what runs at the start, one for the bits that
/// are clocks, whose half periods are whole times of 50 ms.
void add_organization_blocks(const projects::Project& project, std::set<std::string>& names,
                             std::vector<NewTask>& tasks) {
    using enum projects::OrganizationBlock::Start;
    std::vector<projects::OrganizationBlock> blocks = project.organization_blocks;
    std::ranges::stable_sort(blocks, {}, &projects::OrganizationBlock::number);
    const auto add = [&](std::string name, const NewTask& task) {
        while (!names.insert(name).second) name += '_';
        tasks.push_back(task);
        tasks.back().name = name;
    };
    if (std::ranges::all_of(blocks, is_memory)) return;
    const auto add_all = [&](std::initializer_list<projects::OrganizationBlock::Start> starts,
                             const char* name, const NewTask& task) {
        NewTask made = task;
        for (const auto start : starts)
            for (const auto& block : blocks)
                if (block.start == start) made.programs.push_back({block.name});
        if (!made.programs.empty()) add(name, made);
    };
    add_all({system_memory, cycle}, "main", {{}, 10'000'000, 1, {}});
    for (const auto& block : blocks)
        if (block.start == cyclic_interrupt)
            add(plain_name(block.name.text), {{},
                                              100'000'000,
                                              8 + std::clamp<std::int64_t>(block.number - 30, 0, 8),
                                              {{block.name}},
                                              "the export does not say the interval"});
    add_all({startup}, "startup", {{}, 0, 0, {}});
    add_all({clock_memory}, "clock_memory", {{}, 50'000'000, 17, {}});
}

/// The signal of a variable in a list, or of an address, which is an input where it is of area I.
std::string signal_of(std::string_view variable) {
    if (lower(variable).starts_with("%i"))
        return fmt::format("inputs.{}", plain_name(variable.substr(1)));
    if (variable.starts_with('%')) return fmt::format("\"{}\"", variable);
    return fmt::format("globals.{}", variable.substr(variable.rfind('.') + 1));
}

/// The priority is said by others.
NewTask task_of(const projects::ProjectTask& task) {
    constexpr std::int64_t usual = 10'000'000;
    NewTask made{{}, task.every > 0 ? task.every : usual, 1, task.programs};
    if (task.every > 0) return made;
    if (task.is_free)
        made.note = "it runs freely there, without an interval";
    else if (task.event.is_edge)
        made.on = signal_of(task.event.text);
    else
        made.note = "the project does not say the interval";
    return made;
}

/// What has no task runs behind all others, as often as the fastest of them.
NewTask background_of(const projects::Project& project, const projects::ProjectTask& task) {
    NewTask made = task_of(task);
    made.note = "without a TASK a controller runs it again and again";
    std::int64_t least = 0;
    for (const projects::ProjectTask& other : project.tasks)
        if (other.every > 0 && (least == 0 || other.every < least)) least = other.every;
    if (least > 0) made.every = least;
    return made;
}

}  // namespace

std::string plain_name(std::string_view text) {
    std::string name;
    for (const char c : text) name += is_letter(c) || is_digit(c) ? c : '_';
    return name.empty() || is_digit(name.front()) ? "task_" + name : name;
}

bool is_taken(const projects::ProjectTask& task) {
    return task.every > 0 || task.event.is_edge || task.counts_always || task.is_free;
}

std::string remark_on_event(const projects::ProjectTask& task) {
    std::string programs;
    for (const projects::TaskProgram& program : task.programs)
        programs += (programs.empty() ? "" : ", ") + program.text;
    return fmt::format(
        "  # '{}' runs {} at {}: give it a task such as x: {{on: a.signal}}\n", task.name.text,
        programs.empty() ? "nothing" : programs,
        task.event.text.empty() ? "an event" : fmt::format("the event '{}'", task.event.text));
}

void forget_lost_events(std::span<const BlockType> kinds, projects::Project& project) {
    constexpr std::string_view globals = "globals";
    const auto list = std::ranges::find(kinds, globals, &BlockType::name);
    for (projects::ProjectTask& task : project.tasks) {
        const std::string signal = signal_of(task.event.text);
        if (!task.event.is_edge || !signal.starts_with("globals.")) continue;
        const auto is_it = [&](const Field& field) {
            return lower(field.name) == lower(signal.substr(globals.size() + 1));
        };
        if (list == kinds.end() || std::ranges::none_of(list->fields, is_it))
            task.event.is_edge = false;
    }
}

bool is_memory(const projects::OrganizationBlock& block) {
    using enum projects::OrganizationBlock::Start;
    return block.start == clock_memory || block.start == system_memory;
}

std::vector<NewTask> tasks_of(const projects::Project& project) {
    std::vector<NewTask> tasks;
    std::set<std::int64_t, std::greater<>> priorities;
    for (const projects::ProjectTask& task : project.tasks)
        if (is_taken(task) && !task.is_background) priorities.insert(task.priority);
    const bool has_background =
        std::ranges::any_of(project.tasks, &projects::ProjectTask::is_background);
    std::set<std::string> names;
    for (const projects::ProjectTask& task : project.tasks) {
        if (!is_taken(task)) continue;
        NewTask made = task.is_background ? background_of(project, task) : task_of(task);
        made.name = task.is_background ? "background" : plain_name(task.name.text);
        if (names.contains(made.name) && !task.resource.empty())
            made.name = plain_name(fmt::format("{}_{}", task.resource, made.name));
        while (!names.insert(made.name).second) made.name += '_';
        if (!task.is_background)
            made.priority = std::distance(priorities.begin(), priorities.find(task.priority)) + 1 +
                            (has_background ? 1 : 0);
        tasks.push_back(std::move(made));
    }
    add_organization_blocks(project, names, tasks);
    if (tasks.empty()) tasks.push_back({"main", 10'000'000, 1, {}});
    return tasks;
}

}  // namespace lineshaft

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "runtime/outside/outside.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

using Places = std::set<const std::byte*>;

/// The places that stimuli, replays and forces set, and of what is retained.
Places set_from_outside(const Machine& machine) {
    Places places;
    for (const Stimulus& stimulus : machine.stimuli) places.insert(stimulus.target);
    for (const Task& task : machine.tasks)
        for (const Stimulus& stimulus : task.stimuli) places.insert(stimulus.target);
    for (const Replay& replay : machine.replays) places.insert(replay.target());
    for (const Force& force : machine.forces) places.insert(force.live);
    for (const Retained& kept : machine.retained) places.insert(kept.live);
    return places;
}

void check_block(Connecting& to, int number, const Places& set) {
    const Instance& block = to.net.instance(number);
    if (!block.known() || !block.type->misfit) return;
    const std::byte* live = to.machine.blocks[static_cast<std::size_t>(number)].live;
    const auto misfit = block.type->misfit(live, [&](std::string_view name) {
        const Field& field = *block.type->find_settable(name);
        const Port port = to.net.port(number, field);
        return !block.wired[static_cast<std::size_t>(port.field)] &&
               !set.contains(live + field.offset);
    });
    if (!misfit) return;
    const BlockPlan& plan = to.program.blocks[static_cast<std::size_t>(number)];
    const auto at = std::ranges::find(plan.ports, misfit->field,
                                      [](const auto& port) { return port.first.text; });
    const Node& place = at != plan.ports.end() ? at->second : plan.name;
    if (place.is_scalar())
        to.read.fail(code::number_out_of_range, place,
                     fmt::format("'{}' is out of range for '{}'", place.text, misfit->field),
                     misfit->why);
    else
        to.read.fail(code::number_out_of_range, place,
                     fmt::format("'{}' is not used", misfit->field), misfit->why);
}

void warn_of_doubt(const Connecting& to, int number) {
    const Instance& block = to.net.instance(number);
    if (!block.known() || !block.type->doubt) return;
    const auto at = [&](std::int64_t instance) {
        return to.machine.blocks[static_cast<std::size_t>(instance)].live;
    };
    const auto doubt = block.type->doubt(at(number), at);
    if (!doubt) return;
    const BlockPlan& plan = to.program.blocks[static_cast<std::size_t>(number)];
    to.read.diagnostics().warn(
        code::cam_does_not_close, plan.name.mark,
        fmt::format("'{}' of {} {}", doubt->field, block.described(), doubt->why));
}

/// A command, which refers to an axis, begins at a rising edge: where nothing makes one, it never
/// does. Other blocks with such an input may have other ways to begin.
void warn_of_idle_command(const Connecting& to, int number, const Places& set) {
    constexpr std::string_view execute = "Execute";
    const Instance& block = to.net.instance(number);
    const Field* pin = block.known() ? block.type->find_settable(execute) : nullptr;
    if (!pin || pin->direction != Direction::input || pin->type != Type::boolean) return;
    const auto& fields = block.type->fields;
    if (std::ranges::count(fields, Direction::in_out, &Field::direction) == 0) return;
    const BlockPlan& plan = to.program.blocks[static_cast<std::size_t>(number)];
    const std::byte* place = to.machine.blocks[static_cast<std::size_t>(number)].live + pin->offset;
    const bool is_said = std::ranges::any_of(
        plan.ports, [&](const auto& port) { return same_letters(port.first.text, execute); });
    const std::string signal = fmt::format("{}.{}", block.name, pin->name);
    const bool is_mapped = std::ranges::any_of(to.program.registers, [&](const RegisterPlan& r) {
        return same_letters(r.signal.text, signal);
    });
    if (is_said || is_mapped || set.contains(place) || as_real(load(Type::boolean, place)) != 0)
        return;
    to.read.diagnostics().warn(
        code::command_never_begins, plan.name.mark,
        fmt::format("nothing in the program sets '{}' of {}, so it never begins", pin->name,
                    block.described()),
        fmt::format("write {0}: inputs.start, for instance, or {0}: true to begin at once",
                    pin->name));
}

/// The soonest, where it is that of a scan.
std::int64_t begin_of(const Net& net, const StimulusPlan& plan) {
    if (!plan.task) return plan.at;
    const auto task = std::ranges::find(net.tasks, plan.task->text, &TaskSettings::name);
    if (task == net.tasks.end() || task->on_event) return 0;
    const Wide time = static_cast<Wide>(plan.at) * task->every + task->offset - task->jitter;
    return static_cast<std::int64_t>(std::min<Wide>(time, never));
}

}  // namespace

void check_constants(Connecting& to) {
    const Places set = set_from_outside(to.machine);
    for (int i = 0; i < static_cast<int>(to.net.instances.size()); ++i) {
        check_block(to, i, set);
        warn_of_idle_command(to, i, set);
        warn_of_doubt(to, i);
    }
}

/// The run may end sooner still, by `until`.
void warn_of_what_comes_late(const Connecting& to) {
    const std::int64_t end = to.program.run.duration;
    if (end == 0) return;
    const auto warn = [&](const char* code, const Mark& mark, const std::string& what) {
        to.read.diagnostics().warn(
            code, mark, fmt::format("{} after the end of the run, {}", what, format_time(end)),
            "let the run be longer: run: {for: ...}");
    };
    for (const StimulusPlan& plan : to.program.stimuli)
        if (begin_of(to.net, plan) > end)
            warn(code::after_the_end, plan.mark, "the stimulus comes");
    for (const ReplayPlan& plan : to.program.replays)
        if (plan.at > end) warn(code::after_the_end, plan.file.mark, "the replay begins");
    for (const ForcePlan& plan : to.program.forces)
        if (plan.from > end) warn(code::after_the_end, plan.mark, "the force begins");
    for (const ExpectPlan& plan : to.program.expectations)
        if (plan.from > end)
            warn(code::expectation_never_judged, plan.mark, "the expectation would be looked at");
        else if (plan.when == ExpectPlan::When::always && plan.until != never && plan.until > end)
            warn(code::expectation_never_judged, plan.mark, "the expectation would be decided");
}

}  // namespace lineshaft

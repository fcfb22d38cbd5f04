#include <algorithm>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"
#include "runtime/net/linker.hpp"

namespace lineshaft {

/// The readable signal, so an output before an input of the same name; of an output of the program
/// the signal that it shows.
std::optional<Target> Linker::target(const Node& node) {
    auto found = find_signal(node, node.text);
    if (!found) return {};
    if (found->name.starts_with("outputs."))
        found = find_signal(node, outputs_.at(found->name.substr(8)));
    set_.insert(found->name);
    Target out{.signal = std::move(*found)};
    out.field.name = node.text;
    out.field.type = out.signal.type;
    out.field.names = out.signal.names;
    out.field.direction = Direction::input;
    out.live = out.published = const_cast<std::byte*>(out.signal.slot);
    if (out.signal.task < 0) return out;
    const auto dot = out.signal.name.find('.');
    out.block = &blocks_[static_cast<std::size_t>(by_name_.at(out.signal.name.substr(0, dot)))];
    const std::string_view name = out.field.name;
    out.field = *out.block->type->find_readable(out.signal.name.substr(dot + 1));
    out.field.name = name;
    out.live = out.block->live + out.field.offset;
    return out;
}

std::optional<Value> Linker::literal(const Target& target, const Node& value) {
    return read_literal(read_, value, target.field, parsed(target.signal.unit));
}

void Linker::connect_stimuli() {
    for (const StimulusPlan& plan : program_.stimuli) {
        const int task = plan.task ? find_task(*plan.task) : -1;
        if (plan.task && task < 0) continue;
        for (const auto& [key, value] : plan.set) connect_stimulus(plan, task, key, value);
        if (!plan.cost || task < 0) continue;
        auto& costs = out_.machine.tasks[static_cast<std::size_t>(task)].costs;
        if (!costs.empty() && costs.back().scan == plan.at)
            read_.fail("L0212", *plan.task,
                       fmt::format("scan {} of '{}' has a cost already", plan.at, plan.task->text));
        costs.push_back({plan.at, *plan.cost});
    }
}

/// What a stimulus may set: an input that no wire feeds. With the unit that it takes.
std::optional<Target> Linker::settable(const Node& node) {
    auto set = target(node);
    if (!set) return {};
    if (wired_.contains(set->signal.name)) {
        read_.fail("L0409", node, fmt::format("'{}' is wired and cannot be set", set->signal.name),
                   "wire an input of the program (inputs.name) and set that, or force it");
        return {};
    }
    if (!set->block) return set;
    const auto dot = set->signal.name.find('.');
    const Field* field = set->block->type->find_settable(set->signal.name.substr(dot + 1));
    if (!field || field->direction == Direction::parameter) {
        read_.fail("L0405", node,
                   fmt::format("'{}' is {} and cannot be set", set->signal.name,
                               field ? "a parameter" : "an output"),
                   field ? "a stimulus sets inputs"
                         : "a stimulus sets inputs; a force takes outputs, too");
        return {};
    }
    set->field = *field;
    set->live = set->block->live + field->offset;
    set->signal.unit = unit_of(*set->block, *field).text;
    return set;
}

void Linker::connect_stimulus(const StimulusPlan& plan, int task, const Node& key,
                              const Node& value) {
    const auto set = settable(key);
    if (!set) return;
    const auto v = literal(*set, value);
    if (!v) return;
    auto& list = task < 0 ? out_.machine.stimuli
                          : out_.machine.tasks[static_cast<std::size_t>(task)].stimuli;
    list.push_back(
        {plan.at, set->live, set->field.type, *v, fmt::format("{} = {}", key.text, value.text)});
}

void Linker::connect_forces() {
    for (const ForcePlan& plan : program_.forces) connect_force(plan);
}

void Linker::connect_force(const ForcePlan& plan) {
    const auto forced = target(plan.signal);
    if (!forced) return;
    const std::string& name = forced->signal.name;
    if (forced->field.direction == Direction::parameter)
        return read_.fail("L0405", plan.signal,
                          fmt::format("'{}' is a parameter and cannot be forced", name),
                          "a force takes inputs and outputs");
    const auto value = literal(*forced, plan.value);
    if (!value) return;
    auto& forces = out_.machine.forces;
    const auto overlaps = [&](const Force& other) {
        return other.live == forced->live && plan.from < other.until && other.from < plan.until;
    };
    if (std::ranges::any_of(forces, overlaps))
        return read_.fail("L0212", plan.signal,
                          fmt::format("'{}' is forced twice at one time", name));
    const bool split = forced->published != forced->live;
    forces.push_back({.from = plan.from,
                      .until = plan.until,
                      .live = forced->live,
                      .published = split ? forced->published : nullptr,
                      .block = forced->block ? forced->block->live : nullptr,
                      .is_output = forced->block && forced->field.direction == Direction::output,
                      .task = forced->signal.task,
                      .type = forced->field.type,
                      .value = *value,
                      .name = name,
                      .text = fmt::format("force {} = {}", name, plan.value.text)});
}

/// The run may end sooner still, by `until`.
void Linker::warn_of_what_comes_late() {
    const std::int64_t end = out_.machine.duration;
    if (end == 0) return;
    const auto warn = [&](const char* code, const Mark& mark, const std::string& what) {
        read_.diagnostics().warn(
            code, mark, fmt::format("{} after the end of the run, {}", what, format_time(end)),
            "let the run be longer: run: {for: ...}");
    };
    for (const StimulusPlan& plan : program_.stimuli)
        if (begin_of(plan) > end) warn("L0801", plan.mark, "the stimulus comes");
    for (const ReplayPlan& plan : program_.replays)
        if (plan.at > end) warn("L0801", plan.file.mark, "the replay begins");
    for (const ForcePlan& plan : program_.forces)
        if (plan.from > end) warn("L0801", plan.mark, "the force begins");
    for (const ExpectPlan& plan : program_.expectations)
        if (plan.at && *plan.at > end)
            warn("L0802", plan.mark, "the expectation would be looked at");
}

/// The soonest, where it is that of a scan.
std::int64_t Linker::begin_of(const StimulusPlan& plan) const {
    if (!plan.task) return plan.at;
    const auto task = std::ranges::find(out_.machine.tasks, plan.task->text, &Task::name);
    if (task == out_.machine.tasks.end() || task->on_event) return 0;
    __extension__ using Wide = __int128;
    const Wide time = static_cast<Wide>(plan.at) * task->every + task->offset - task->jitter;
    return static_cast<std::int64_t>(std::min<Wide>(time, never));
}

void Linker::warn_of_unused_inputs() {
    for (const auto& [name, value] : program_.inputs)
        if (!used_inputs_.contains(name.text))
            read_.diagnostics().warn(
                "L0803", name.mark, fmt::format("nothing uses the input '{}'", name.text),
                fmt::format("wire inputs.{} where it is meant, or remove it", name.text));
}

void Linker::connect_retained() {
    for (const Node& node : program_.retain) {
        auto kept = target(node);
        if (!kept) continue;
        if (kept->field.direction == Direction::parameter || wired_.contains(kept->signal.name))
            read_.fail("L0411", node,
                       fmt::format(
                           "'{}' is {} and cannot be retained", kept->signal.name,
                           kept->field.direction == Direction::parameter ? "a parameter" : "wired"),
                       "retain outputs of blocks and inputs that are set from outside");
        else
            out_.machine.retained.push_back({std::move(kept->signal), kept->live, kept->published});
    }
}

}  // namespace lineshaft

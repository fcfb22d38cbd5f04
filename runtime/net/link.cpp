#include <algorithm>

#include <fmt/format.h>

#include "runtime/net/linker.hpp"

namespace lineshaft {

namespace {

/// Of the main task, as Siemens' controllers have it [ns].
constexpr std::int64_t default_maximum_cycle_time = 150'000'000;

constexpr std::size_t alignment = alignof(std::max_align_t);

std::size_t aligned(std::size_t size) {
    return (size + alignment - 1) / alignment * alignment;
}

}  // namespace

Linked Linker::link() {
    place_tasks();
    choose_main_task();
    find_blocks();
    order_blocks();
    lay_out();
    place_blocks();
    set_inputs();
    wires_.resize(blocks_.size());
    for (Instance& block : blocks_) set_choices(block);
    for (Instance& block : blocks_) set_block(block);
    make_calls();
    for (Task& task : out_.machine.tasks)
        if (task.published != task.live) std::memcpy(task.published, task.live, task.size);
    collect_errors();
    collect_devices();
    collect_signals();
    connect_outputs();
    connect_events();
    connect_overruns();
    connect_run();
    connect_stimuli();
    connect_replays();
    connect_forces();
    connect_retained();
    connect_traces();
    connect_expectations();
    return std::move(out_);
}

void Linker::place_tasks() {
    for (const TaskPlan& plan : program_.tasks) {
        Task task;
        task.name = plan.name;
        task.on_event = plan.every == 0;
        task.motion = plan.motion;
        task.maximum_cycle_time = plan.maximum_cycle_time.value_or(never);
        task.every = plan.every;
        task.offset = plan.offset;
        task.priority = plan.priority;
        task.jitter = plan.jitter;
        task.cost = plan.cost;
        task.cost_jitter = plan.cost_jitter;
        out_.machine.tasks.push_back(std::move(task));
    }
    std::ranges::stable_sort(out_.machine.tasks, std::ranges::greater{}, &Task::priority);
    for (const Task& task : out_.machine.tasks) task_names_.push_back(task.name);
}

void Linker::choose_main_task() {
    auto& tasks = out_.machine.tasks;
    for (std::size_t i = 0; i < tasks.size(); ++i)
        if (!tasks[i].on_event) out_.machine.main_task = static_cast<int>(i);
    if (out_.machine.main_task < 0) return;
    Task& main = tasks[static_cast<std::size_t>(out_.machine.main_task)];
    if (main.maximum_cycle_time == never) main.maximum_cycle_time = default_maximum_cycle_time;
}

/// -1, and L0206, when there is none.
int Linker::find_task(const Node& name) {
    if (name.text.empty()) return -1;
    const auto it = std::ranges::find(task_names_, name.text);
    if (it != task_names_.end()) return static_cast<int>(it - task_names_.begin());
    if (program_.tasks_known)
        read_.fail("L0206", name, fmt::format("unknown task '{}'", name.text),
                   suggest(name.text, task_names_));
    return -1;
}

void Linker::add_cost(const BlockPlan& plan, int index) {
    if (!plan.cost || index < 0 || !read_.expect_scalar(*plan.cost, "'cost'")) return;
    Task& task = out_.machine.tasks[static_cast<std::size_t>(index)];
    task.cost += read_.time(*plan.cost).value_or(0);
    if (!task.on_event && task.cost - task.cost_jitter > task.every)
        read_.fail("L0305", *plan.cost,
                   fmt::format("the costs of task '{}' and its blocks are above its interval: it "
                               "never ends in time",
                               task.name));
}

/// Then its outputs are published later than they are made.
bool Linker::takes_time(int task) const {
    const std::string& name = task_names_[static_cast<std::size_t>(task)];
    return out_.machine.tasks[static_cast<std::size_t>(task)].cost > 0 ||
           std::ranges::any_of(program_.stimuli, [&](const StimulusPlan& plan) {
               return plan.cost && plan.task && plan.task->text == name;
           });
}

BlockInfo Linker::info(const Instance& block) const {
    BlockInfo info{.block = fmt::format("'{}' ({})", block.plan->name.text, block.type->name)};
    Diagnostics reported;
    if (block.plan->cost) info.cost = Reader(reported).time(*block.plan->cost).value_or(0);
    return info;
}

void Linker::find_blocks() {
    for (const BlockPlan& plan : program_.blocks) {
        Instance block{.plan = &plan, .position = static_cast<int>(blocks_.size())};
        if (!plan.type.text.empty()) {
            block.type = catalog_.find(plan.type.text);
            if (!block.type)
                read_.fail("L0205", plan.type,
                           fmt::format("unknown block type '{}'", plan.type.text),
                           suggest(plan.type.text, catalog_.names()));
        }
        block.task = find_task(plan.task);
        add_cost(plan, block.task);
        by_name_.emplace(plan.name.text, block.position);
        block_names_.push_back(plan.name.text);
        blocks_.push_back(std::move(block));
    }
}

void Linker::lay_out() {
    auto& tasks = out_.machine.tasks;
    const Instance* before = nullptr;
    for (Instance* block : order_) {
        Task& task = tasks[static_cast<std::size_t>(block->task)];
        if (!before || before->call() != block->call()) task.size = aligned(task.size);
        block->offset = task.size;
        task.size += block->type->size;
        before = block;
    }
    for (Task& task : tasks) task.size = aligned(task.size);
    const std::size_t input_bytes = aligned(8 * program_.inputs.size());
    std::size_t total = input_bytes;
    for (std::size_t i = 0; i < tasks.size(); ++i)
        total += tasks[i].size * (takes_time(static_cast<int>(i)) ? 2 : 1);
    auto& memory = out_.machine.memory;
    memory.resize(total);
    std::byte* place = memory.data() + input_bytes;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        Task& task = tasks[i];
        task.live = task.published = place;
        place += task.size;
        if (!takes_time(static_cast<int>(i))) continue;
        task.published = place;
        place += task.size;
    }
}

void Linker::place_blocks() {
    for (Instance& block : blocks_) {
        if (!block.known()) continue;
        const Task& task = out_.machine.tasks[static_cast<std::size_t>(block.task)];
        block.live = task.live + block.offset;
        block.published = block.type->is_device() ? block.live : task.published + block.offset;
        block.type->construct(block.live);
        const Field* seed = block.type->find_settable("seed");
        if (seed && seed->direction == Direction::parameter && seed->type == Type::integer)
            out_.machine.block_seeds.push_back({block.live + seed->offset, block.plan->name.text});
    }
}

void Linker::set_inputs() {
    std::byte* slot = out_.machine.memory.data();
    for (const auto& [name, value] : program_.inputs) {
        input_names_.push_back(name.text);
        Signal signal{.name = "inputs." + name.text, .unit = {}, .names = {}, .slot = slot};
        Value initial;
        if (!value.quoted && (value.text == "true" || value.text == "false")) {
            signal.type = Type::boolean;
            initial = value.text == "true";
        } else {
            if (!value.quoted && is_identifier(value.text))
                read_.fail("L0307", value, fmt::format("'{}' is no value of an input", value.text),
                           "write true, false or a number");
            const auto quantity = is_identifier(value.text) ? std::nullopt : read_.quantity(value);
            if (!quantity) continue;
            if (quantity->is_integer && !quantity->has_unit) {
                signal.type = Type::integer;
                initial = quantity->integer;
            } else {
                signal.type = Type::real;
                signal.unit = quantity->unit.text;
                initial = quantity->number;
            }
        }
        store(signal.type, slot, initial);
        inputs_.emplace(name.text, signal);
        out_.machine.signals.push_back(signal);
        slot += 8;
    }
}

void Linker::collect_errors() {
    for (const Instance& block : blocks_) {
        if (!block.known()) continue;
        const Field* error = block.type->find_readable("error");
        if (!error || error->type != Type::boolean || error->direction != Direction::output)
            continue;
        const Field* id = block.type->find_readable("error_id");
        ErrorFlag flag;
        flag.error = reinterpret_cast<const bool*>(block.live + error->offset);
        if (id) {
            flag.error_id = reinterpret_cast<const std::int64_t*>(block.live + id->offset);
            flag.names = id->names;
        }
        flag.block = info(block).block;
        out_.machine.tasks[static_cast<std::size_t>(block.task)].errors.push_back(std::move(flag));
    }
}

WarningCount Linker::warnings_of(const Instance& block) const {
    const Field* count = block.type->find_readable("warnings");
    const Field* id = block.type->find_readable("warning_id");
    if (!count || !id) return {};
    return {.count = reinterpret_cast<const std::int64_t*>(block.live + count->offset),
            .id = reinterpret_cast<const std::int64_t*>(block.live + id->offset),
            .names = id->names,
            .block = info(block).block};
}

void Linker::collect_devices() {
    for (const Instance& block : blocks_)
        if (block.known() && block.type->is_device())
            out_.machine.devices.push_back({.calls = block.type->device,
                                            .block = block.live,
                                            .name = block.plan->name.text,
                                            .task = block.task,
                                            .warnings = warnings_of(block)});
    if (out_.machine.devices.empty()) return;
    for (const ExpectPlan& plan : program_.expectations)
        if (plan.at) out_.machine.looks.push_back(*plan.at);
    std::ranges::sort(out_.machine.looks);
}

Linked link(const Program& program, const Catalog& catalog, Diagnostics& out) {
    return Linker(program, catalog, out).link();
}

}  // namespace lineshaft

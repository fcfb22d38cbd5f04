#include "runtime/machine/lay_out.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t alignment = alignof(std::max_align_t);

std::size_t aligned(std::size_t size) {
    return (size + alignment - 1) / alignment * alignment;
}

std::vector<int> levels_of(const Net& net) {
    std::vector<int> levels(net.instances.size());
    auto orders = net.orders;
    std::ranges::stable_sort(orders, {}, &Order::after);
    for (const Order& order : orders) {
        int& level = levels[static_cast<std::size_t>(order.after)];
        level = std::max(level,
                         levels[static_cast<std::size_t>(order.before)] + (order.together ? 0 : 1));
    }
    return levels;
}

/// The kinds of block, by their first appearance in the file.
std::vector<int> kinds_of(const Net& net) {
    std::unordered_map<const BlockType*, int> numbers;
    std::vector<int> kinds;
    for (const Instance& block : net.instances)
        kinds.push_back(
            numbers.try_emplace(block.type, static_cast<int>(numbers.size())).first->second);
    return kinds;
}

struct Layout {
    const Net& net;
    Machine& machine;
    std::vector<int> levels, kinds;
    std::vector<int> sequence = {};         ///< the known instances as they stand in memory
    std::vector<std::size_t> offsets = {};  ///< of each instance in its task's memory

    auto call(int number) const {
        const auto i = static_cast<std::size_t>(number);
        return std::tuple(net.instances[i].task, levels[i], kinds[i]);
    }
};

void place_blocks(Layout& layout) {
    const auto& instances = layout.net.instances;
    for (int i = 0; i < static_cast<int>(instances.size()); ++i)
        if (layout.net.instance(i).known()) layout.sequence.push_back(i);
    std::ranges::stable_sort(layout.sequence, {}, [&](int i) { return layout.call(i); });
    layout.offsets.resize(instances.size());
    int before = -1;
    for (const int i : layout.sequence) {
        const Instance& block = layout.net.instance(i);
        Task& task = layout.machine.tasks[static_cast<std::size_t>(block.task)];
        if (before < 0 || layout.call(before) != layout.call(i)) task.size = aligned(task.size);
        layout.offsets[static_cast<std::size_t>(i)] = task.size;
        task.size += block.type->size;
        before = i;
    }
}

void place_tasks(Layout& layout) {
    const std::size_t inputs = aligned(8 * layout.net.inputs.size());
    std::size_t total = inputs;
    for (Task& task : layout.machine.tasks) {
        task.size = aligned(task.size);
        total += task.size * (task.takes_time() ? 2 : 1);
    }
    layout.machine.memory.resize(total);
    std::byte* place = layout.machine.memory.data() + inputs;
    for (Task& task : layout.machine.tasks) {
        task.live = task.published = place;
        place += task.size;
        if (!task.takes_time()) continue;
        task.published = place;
        place += task.size;
    }
}

/// Code in Structured Text may have a variable `error` of its own: its first two fields say how its
/// scan ended.
void add_error_flag(const Instance& block, std::byte* live, Task& task) {
    const bool is_code = block.type->owner && !block.type->single;
    const auto find = [&](std::string_view name, std::size_t place) {
        return is_code ? &block.type->fields[place] : block.type->find_readable(name);
    };
    const Field* error = find("error", 0);
    if (!error || error->type != Type::boolean || error->direction != Direction::output) return;
    ErrorFlag flag;
    flag.error = reinterpret_cast<const bool*>(live + error->offset);
    const Field* id = find("error_id", 1);
    if (!id) id = block.type->find_readable("ErrorID");
    if (id) {
        flag.error_id = reinterpret_cast<const std::int64_t*>(live + id->offset);
        flag.names = id->names;
    }
    flag.block = block.described();
    flag.type = block.type;
    flag.memory = live;
    task.errors.push_back(std::move(flag));
}

WarningCount warnings_of(const Instance& block, std::byte* live) {
    const Field* count = block.type->find_readable("warnings");
    const Field* id = block.type->find_readable("warning_id");
    if (!count || !id) return {};
    return {.count = reinterpret_cast<const std::int64_t*>(live + count->offset),
            .id = reinterpret_cast<const std::int64_t*>(live + id->offset),
            .names = id->names,
            .block = block.described()};
}

void add_seed(const Instance& block, std::byte* live, Machine& machine) {
    const Field* seed = block.type->find_settable("seed");
    if (seed && seed->direction == Direction::parameter && seed->type == Type::integer)
        machine.block_seeds.push_back({live + seed->offset, block.name});
}

void fill_blocks(Layout& layout) {
    Machine& machine = layout.machine;
    machine.instances.resize(layout.net.instances.size());
    for (std::size_t i = 0; i < layout.net.instances.size(); ++i) {
        const Instance& block = layout.net.instances[i];
        BlockPlace& place = machine.blocks.emplace_back(BlockPlace{block.name, block.type});
        machine.types.push_back(block.type);
        if (!block.known()) continue;
        Task& task = machine.tasks[static_cast<std::size_t>(block.task)];
        const bool is_device = block.type->is_device();
        place.live = task.live + layout.offsets[i];
        place.published = is_device ? place.live : task.published + layout.offsets[i];
        std::ranges::copy(block.image, place.live);
        machine.instances[i] = place.live;
        task.infos.push_back({block.described(), block.cost});
        add_error_flag(block, place.live, task);
        if (const auto at = block.type->time_taken)
            task.times_taken.push_back(reinterpret_cast<const std::int64_t*>(place.live + *at));
        add_seed(block, place.live, machine);
        if (is_device)
            machine.devices.push_back({.calls = block.type->device,
                                       .block = place.live,
                                       .name = block.name,
                                       .task = block.task,
                                       .warnings = warnings_of(block, place.live)});
    }
    for (const InputNode& input : layout.net.inputs)
        if (input.signal)
            store(input.signal->type, machine.live(input.signal->port), input.initial);
    for (Task& task : machine.tasks)
        if (task.published != task.live) std::memcpy(task.published, task.live, task.size);
}

void add_views(const Net& net, Machine& machine) {
    for (int task = 0; task < static_cast<int>(net.tasks.size()); ++task) {
        auto& seen = machine.seen.emplace_back(machine.instances);
        for (std::size_t i = 0; i < seen.size(); ++i)
            if (net.instances[i].task != task) seen[i] = machine.blocks[i].published;
    }
}

/// All that BlockType::find_readable gives, in their order: in a time that grows as their number.
std::vector<const Field*> readable_fields(const BlockType& type) {
    std::unordered_map<std::string, const Field*> by_name;
    by_name.reserve(type.fields.size());
    for (const bool is_own : {true, false})
        for (const Field& f : type.fields)
            if ((f.direction == Direction::output || f.direction == Direction::local) == is_own)
                by_name.emplace(lower(f.name), &f);
    std::vector<const Field*> all;
    for (const Field& f : type.fields)
        if (f.direction != Direction::in_out && by_name.at(lower(f.name)) == &f) all.push_back(&f);
    return all;
}

void add_signals(const Net& net, Machine& machine) {
    for (const InputNode& input : net.inputs)
        if (input.signal) machine.signals.push_back(machine.placed(*input.signal));
    for (std::size_t i = 0; i < net.instances.size(); ++i) {
        const Instance& block = net.instances[i];
        if (!block.known()) continue;
        for (const Field* field : readable_fields(*block.type))
            machine.signals.push_back(
                machine.placed(net.signal(net.port(static_cast<int>(i), *field))));
    }
    for (const OutputNode& output : net.outputs) {
        if (!output.shows) continue;
        machine.signals.push_back(machine.placed(*output.shows));
        machine.signals.back().name = "outputs." + output.name;
    }
}

}  // namespace

Machine lay_out(const Net& net) {
    Machine machine;
    machine.main_task = net.main_task;
    for (const TaskSettings& settings : net.tasks)
        static_cast<TaskSettings&>(machine.tasks.emplace_back()) = settings;
    Layout layout{net, machine, levels_of(net), kinds_of(net)};
    for (const Instance& block : net.instances)
        if (block.known() && block.type->time_taken)
            machine.tasks[static_cast<std::size_t>(block.task)].is_timed = true;
    place_blocks(layout);
    place_tasks(layout);
    fill_blocks(layout);
    add_views(net, machine);
    std::erase_if(layout.sequence, [&](int i) { return net.instance(i).is_only_named; });
    lay_out_calls(net, layout.sequence, layout.levels, machine);
    add_signals(net, machine);
    return machine;
}

}  // namespace lineshaft

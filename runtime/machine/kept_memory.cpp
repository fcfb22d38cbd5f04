#include "runtime/machine/kept_memory.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lineshaft {

namespace {

/// -1: it does not belong to one.
int task_of(const Machine& machine, const std::byte* block) {
    for (std::size_t i = 0; i < machine.tasks.size(); ++i)
        if (block >= machine.tasks[i].live && block < machine.tasks[i].live + machine.tasks[i].size)
            return static_cast<int>(i);
    return -1;
}

std::string described(const BlockPlace& block) {
    return fmt::format("'{}' ({})", block.name, block.type->name);
}

}  // namespace

KeptMemory::KeptMemory(Machine& machine, std::int64_t now)
    : machine_(machine), now_(now), fresh_(machine.memory) {
    for (const BlockPlace& block : machine.blocks) published_.push_back(block.published);
    find_links();
}

void KeptMemory::find_links() {
    std::vector<LinkedPart> parts;
    for (const BlockPlace& block : machine_.blocks) {
        if (!block.type->add_links) continue;
        parts.clear();
        block.type->add_links(parts, *block.type);
        for (const LinkedPart& part : parts)
            links_.push_back(block.live - machine_.memory.data() +
                             static_cast<std::int64_t>(part.place));
    }
    std::ranges::sort(links_);
}

void KeptMemory::take(const BlockPlace& block, std::byte* place, const std::byte* kept) {
    if (block.type->take)
        block.type->take(place, kept, block.type->context);
    else
        std::copy_n(kept, block.type->size, place);
}

std::string KeptMemory::damaged() const {
    for (std::size_t i = 0; i < machine_.blocks.size(); ++i)
        if (!is_unchanged(i) || !is_valid(i)) return described(machine_.blocks[i]);
    return {};
}

/// Parameters, references and tables are the program's.
bool KeptMemory::is_unchanged(std::size_t number) const {
    const BlockPlace& block = machine_.blocks[number];
    const std::byte* const fresh = fresh_.data() + (block.live - machine_.memory.data());
    const auto same = [&](std::size_t offset, std::size_t size) {
        return std::equal(block.live + offset, block.live + offset + size, fresh + offset);
    };
    for (const Field& field : block.type->fields) {
        const bool is_parameter = field.direction == Direction::parameter;
        const bool may_be_set = block.type->sets_parameter && block.type->sets_parameter(field);
        if ((is_parameter && !may_be_set) || field.direction == Direction::in_out)
            if (!same(field.offset, size_of(field.type))) return false;
        if (may_be_set && !field.admits(load(field.type, block.live + field.offset))) return false;
    }
    return std::ranges::all_of(block.type->tables, [&](const TableField& table) {
        return same(table.size_offset, sizeof(std::int64_t)) &&
               same(table.rows_offset, table.capacity * table.row_size());
    });
}

KeptState KeptMemory::state_of(const BlockPlace& block) const {
    const int task = std::max(task_of(machine_, block.live), 0);
    return {.context = machine_.context_of(*block.type, task),
            .now = now_,
            .tasks = std::ssize(machine_.tasks),
            .links = &links_};
}

void KeptMemory::mend(std::size_t number) {
    const BlockPlace& block = machine_.blocks[number];
    if (!block.type->mend_links) return;
    block.type->mend_links(block.live, state_of(block));
    std::copy_n(block.live, block.type->size, block.published);
}

bool KeptMemory::is_valid(std::size_t number) const {
    const BlockPlace& block = machine_.blocks[number];
    KeptState state = state_of(block);
    if (!lineshaft::is_valid(*block.type, block.live, state)) return false;
    state.is_live = false;
    state.context.seen = published_.data();
    return block.published == block.live ||
           lineshaft::is_valid(*block.type, block.published, state);
}

bool KeptMemory::is_signal(const std::byte* place, Type type, bool published) const {
    const std::byte* const memory = machine_.memory.data();
    for (const Signal& signal : machine_.signals)
        if (signal.port.instance < 0 && memory + 8 * signal.port.field == place)
            return signal.type == type;
    for (const BlockPlace& block : machine_.blocks) {
        const std::byte* first = published ? block.published : block.live;
        if (place < first || place >= first + block.type->size) continue;
        return std::ranges::any_of(block.type->fields, [&](const Field& field) {
            return first + field.offset == place && field.type == type &&
                   field.direction != Direction::parameter && field.direction != Direction::in_out;
        });
    }
    return false;
}

}  // namespace lineshaft

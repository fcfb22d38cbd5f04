#include <algorithm>
#include <functional>

#include "runtime/net/linker.hpp"

namespace lineshaft {

namespace {

/// The shortest that is worth a row.
constexpr std::uint32_t row_size = 4;

/// Those from the first on that are at equal distances.
Row row_of(std::span<const Copy> copies, Transfer transfer) {
    Row row{.first = copies.front(), .transfer = transfer};
    Copy next = row.first;
    if (copies.size() > 1) {
        row.source_step = copies[1].source - next.source;
        row.target_step = copies[1].target - next.target;
    }
    for (const Copy& copy : copies) {
        if (copy.source != next.source || copy.target != next.target) break;
        ++row.count;
        next.source += row.source_step;
        next.target += row.target_step;
    }
    return row;
}

/// Returns how many are in no row.
std::uint32_t append(std::span<const Copy> copies, Transfer transfer, Wires& wires) {
    const std::size_t before = wires.copies.size();
    while (!copies.empty()) {
        const Row row = row_of(copies, transfer);
        const bool is_row = row.count >= row_size;
        if (is_row)
            wires.rows.push_back(row);
        else
            wires.copies.push_back(row.first);
        copies = copies.subspan(is_row ? row.count : 1);
    }
    return static_cast<std::uint32_t>(wires.copies.size() - before);
}

}  // namespace

// Blocks of one kind are called together where their wires allow it: they stand one behind the
// other, with one indirect call for all, and their inputs are copied in one go before it, the same
// input of all as one row (a scan of a hundred small blocks takes 300 ns so, with a list of blocks
// and single wires 337). Blocks are pure, so only what wires carry tells the order of a scan from
// that of the file.

/// Before the wires are checked: one that is wrong counts, too, and is reported later.
void Linker::order_blocks() {
    for (Instance& block : blocks_) {
        if (!block.known()) continue;
        for (const auto& [key, value] : block.plan->ports) {
            const auto wire = parse_wire(value);
            if (!wire) continue;
            const auto found = by_name_.find(wire->signal.substr(0, wire->signal.find('.')));
            if (found == by_name_.end()) continue;
            Instance& source = blocks_[static_cast<std::size_t>(found->second)];
            if (source.task != block.task) continue;
            if (wire->previous)
                source.late_readers.push_back(block.position);
            else
                block.sources.push_back(source.position);
        }
    }
    for (Instance& block : blocks_) {
        if (!block.known()) continue;
        set_level(block);
        order_.push_back(&block);
    }
    std::ranges::stable_sort(order_, std::less{}, &Instance::call);
}

/// Above those whose outputs it waits for, and not below those that want its outputs as they were;
/// above these, too, if they are of another kind.
void Linker::set_level(Instance& block) const {
    const auto instance = [this](int i) -> const Instance& {
        return blocks_[static_cast<std::size_t>(i)];
    };
    for (const int source : block.sources)
        block.level = std::max(block.level, instance(source).level + 1);
    for (const int reader : block.late_readers) {
        const int apart = instance(reader).type == block.type ? 0 : 1;
        block.level = std::max(block.level, instance(reader).level + apart);
    }
}

void Linker::make_calls() {
    for (const Instance& block : blocks_)
        if (block.known())
            out_.machine.tasks[static_cast<std::size_t>(block.task)].infos.push_back(info(block));
    const auto is_other = [](const Instance* a, const Instance* b) {
        return a->call() != b->call();
    };
    for (auto first = order_.begin(); first != order_.end();) {
        const auto end = std::adjacent_find(first, order_.end(), is_other);
        const auto next = end == order_.end() ? end : end + 1;
        append_call({first, next});
        first = next;
    }
}

void Linker::append_call(std::span<const Instance* const> blocks) {
    Task& task = out_.machine.tasks[static_cast<std::size_t>(blocks.front()->task)];
    Call& call = task.calls.emplace_back();
    call.scan = blocks.front()->type->scan;
    call.first = blocks.front()->live;
    call.count = blocks.size();
    call.size = blocks.front()->type->size;
    const auto by_input = [&](auto BlockWires::*transfer) {
        auto all = wires_[static_cast<std::size_t>(blocks.front()->position)].*transfer;
        for (const Instance* block : blocks.subspan(1)) {
            const auto& more = wires_[static_cast<std::size_t>(block->position)].*transfer;
            all.insert(all.end(), more.begin(), more.end());
        }
        std::ranges::stable_sort(all, std::less{}, [&](const auto& wire) {
            return static_cast<std::size_t>(wire.target - call.first) % call.size;
        });
        return all;
    };
    Wires& wires = task.wires;
    const std::size_t rows = wires.rows.size();
    call.words = append(by_input(&BlockWires::words), Transfer::word, wires);
    call.booleans = append(by_input(&BlockWires::booleans), Transfer::boolean, wires);
    call.negated = append(by_input(&BlockWires::negated), Transfer::negated, wires);
    call.widened = append(by_input(&BlockWires::widened), Transfer::widened, wires);
    call.rows = static_cast<std::uint32_t>(wires.rows.size() - rows);
    const auto scaled = by_input(&BlockWires::scaled);
    wires.scaled.insert(wires.scaled.end(), scaled.begin(), scaled.end());
    call.scaled = static_cast<std::uint32_t>(scaled.size());
}

}  // namespace lineshaft

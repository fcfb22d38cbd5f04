#include <algorithm>
#include <functional>
#include <tuple>

#include "runtime/program/linker.hpp"

namespace lineshaft {

// Blocks of one kind are called together where their wires allow it: one indirect call for all, and
// their inputs copied in one go before it. Blocks are pure, so only what wires carry tells the
// order of a scan from that of the file. A hundred small blocks take 450 ns so instead of 650, see
// tools/bench.

void Linker::make_calls() {
    std::vector<const Instance*> order;
    for (Instance& block : blocks_) {
        if (!block.known()) continue;
        set_level(block);
        order.push_back(&block);
        out_.machine.tasks[static_cast<std::size_t>(block.task)].infos.push_back(info(block));
    }
    const auto place = [](const Instance* block) {
        return std::tuple(block->task, block->level, block->type);
    };
    std::ranges::stable_sort(order, std::less{}, place);
    for (auto first = order.begin(); first != order.end();) {
        const auto end = std::find_if(first, order.end(), [&](const Instance* block) {
            return place(block) != place(*first);
        });
        append_call({first, end});
        first = end;
    }
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

void Linker::append_call(std::span<const Instance* const> blocks) {
    Task& task = out_.machine.tasks[static_cast<std::size_t>(blocks.front()->task)];
    Call& call = task.calls.emplace_back();
    call.scan = blocks.front()->type->scan;
    for (const Instance* block : blocks) call.blocks.push_back(block->live);
    const auto append = [&](auto& to, auto BlockWires::*kind) {
        const std::size_t before = to.size();
        for (const Instance* block : blocks) {
            const auto& from = wires_[static_cast<std::size_t>(block->position)].*kind;
            to.insert(to.end(), from.begin(), from.end());
        }
        return static_cast<std::uint32_t>(to.size() - before);
    };
    call.words = append(task.wires.copies, &BlockWires::words);
    call.booleans = append(task.wires.copies, &BlockWires::booleans);
    call.negated = append(task.wires.copies, &BlockWires::negated);
    call.widened = append(task.wires.copies, &BlockWires::widened);
    call.scaled = append(task.wires.scaled, &BlockWires::scaled);
}

}  // namespace lineshaft

#include "runtime/debug/frames.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lineshaft::debug {

namespace {

std::string name_of_instance(const Machine& machine, const std::byte* place) {
    const auto it = std::ranges::find(machine.blocks, place, &BlockPlace::live);
    return it == machine.blocks.end() ? "" : it->name;
}

auto routine_at(const st::Library::Made& made, std::uint64_t instruction) {
    const auto& routines = made.generated.code.routines;
    return std::ranges::upper_bound(routines, instruction, {}, &st::CodeRoutine::end);
}

Frame frame_at(const st::Halt& halt, const st::Library::Made& made, const Machine& machine,
               std::uint64_t instruction, std::uint64_t base) {
    const auto number = routine_at(made, instruction) - made.generated.code.routines.begin();
    return {.routine = made.checked.order[static_cast<std::size_t>(number)],
            .name = {},
            .mark = {},
            .base = st::place_of(base, halt.root, halt.context),
            .root = halt.root,
            .context = &halt.context,
            .code = &halt.code,
            .machine = &machine};
}

std::size_t statement_at(const st::Code& code, std::uint64_t instruction) {
    const auto behind = std::ranges::upper_bound(code.statements, instruction, {},
                                                 &st::StatementStart::instruction);
    return static_cast<std::size_t>(
        std::max<std::ptrdiff_t>(behind - code.statements.begin() - 1, 0));
}

}  // namespace

FailedScan::FailedScan(Machine& machine, const st::Library::Made& made, const BlockPlace& block,
                       int task)
    : context_(machine.context_of(*block.type, task)),
      halt_{.code = made.generated.code, .root = block.live, .context = context_, .now = now_} {
    const auto slot = [&](std::uint32_t number) {
        return read<std::uint64_t>(block.live + 8 * std::size_t{number});
    };
    const st::EndOfScan end = st::EndOfScan::of(slot(st::place_slot), slot(st::depth_slot));
    halt_.statement = statement_at(halt_.code, end.instruction);
    halt_.depth = end.depth;
    halt_.base = end.frame;
}

Frame innermost(const st::Halt& halt, const st::Library::Made& made, const Machine& machine) {
    const std::uint64_t instruction = halt.code.statements[halt.statement].instruction;
    return frame_at(halt, made, machine, instruction, halt.base);
}

std::vector<Frame> frames_of(const st::Halt& halt, const st::Library::Made& made,
                             const Machine& machine) {
    std::vector<Frame> frames;
    const auto add = [&](std::uint64_t instruction, std::uint64_t base) {
        Frame& frame = frames.emplace_back(frame_at(halt, made, machine, instruction, base));
        frame.name = routine_at(made, instruction)->name;
        frame.mark = made.generated.code.places[instruction].mark();
    };
    const st::StatementStart& statement = halt.code.statements[halt.statement];
    add(statement.instruction, halt.base);
    frames.front().mark = statement.place.mark();
    for (std::uint32_t level = halt.depth; level > 0; --level) {
        const std::byte* call = halt.root + 8 * (halt.code.calls_slot() + 2 * (level - 1));
        add(read<std::uint64_t>(call) - 1, read<std::uint64_t>(call + 8));
    }
    const std::string instance = name_of_instance(machine, halt.root);
    if (!instance.empty()) frames.back().name += fmt::format(" ({})", instance);
    return frames;
}

}  // namespace lineshaft::debug

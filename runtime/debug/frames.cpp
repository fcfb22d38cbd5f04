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

/// Of the frame that the innermost of the calls that run has: what its instruction gave it.
std::uint64_t base_of_last_call(const st::Code& code, std::byte* root, const Context& context,
                                std::uint64_t depth) {
    if (depth == 0) return 0;
    const std::byte* call = root + 8 * (code.calls_slot() + 2 * (depth - 1));
    const auto caller = read<std::uint64_t>(call + 8);
    const st::Instruction& in = code.instructions[read<std::uint64_t>(call) - 1];
    if (in.op == st::Op::call) return caller + in.a;
    return read<std::uint64_t>(st::place_of(caller, root, context) + 8 * std::size_t{in.a});
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
    halt_.statement = statement_at(halt_.code, slot(st::place_slot));
    halt_.depth = static_cast<std::uint32_t>(slot(st::depth_slot));
    halt_.base = base_of_last_call(halt_.code, block.live, context_, halt_.depth);
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

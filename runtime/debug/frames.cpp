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

}  // namespace

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

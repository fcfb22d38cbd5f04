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

Frame frame_at(const st::Library::Made& made, std::uint64_t instruction) {
    const auto& routines = made.generated.code.routines;
    const auto it = routine_at(made, instruction);
    return {.routine = made.checked.order[static_cast<std::size_t>(it - routines.begin())],
            .name = it->name,
            .mark = made.generated.code.places[instruction].mark()};
}

}  // namespace

Frame innermost(const st::Halt& halt, const st::Library::Made& made) {
    const auto number = routine_at(made, halt.code.statements[halt.statement].instruction) -
                        made.generated.code.routines.begin();
    Frame frame;
    frame.routine = made.checked.order[static_cast<std::size_t>(number)];
    frame.base = st::place_of(halt.base, halt.root, halt.context);
    frame.root = halt.root;
    frame.context = &halt.context;
    frame.code = &halt.code;
    return frame;
}

std::vector<Frame> frames_of(const st::Halt& halt, const st::Library::Made& made,
                             const Machine& machine) {
    std::vector<Frame> frames;
    const auto add = [&](std::uint64_t instruction, std::uint64_t base) {
        Frame& frame = frames.emplace_back(frame_at(made, instruction));
        frame.base = st::place_of(base, halt.root, halt.context);
        frame.root = halt.root;
        frame.context = &halt.context;
        frame.code = &halt.code;
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
    frames.back().block = instance;
    return frames;
}

}  // namespace lineshaft::debug

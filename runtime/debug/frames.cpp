#include "runtime/debug/frames.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/st/code/meaning.hpp"

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
            .now = &halt.now,
            .made = &made,
            .machine = &machine,
            .of = &made.generated.code.routines[static_cast<std::size_t>(number)]};
}

std::size_t statement_at(const st::Code& code, std::uint64_t instruction) {
    const auto behind = std::ranges::upper_bound(code.statements, instruction, {},
                                                 &st::StatementStart::instruction);
    return static_cast<std::size_t>(
        std::max<std::ptrdiff_t>(behind - code.statements.begin() - 1, 0));
}

/// A call that runs: the instruction that comes next in it, or its call that goes on.
struct Level {
    std::uint64_t instruction = 0, base = 0;
};

/// The outermost first.
std::vector<Level> levels_of(const st::Halt& halt) {
    std::vector<Level> levels;
    for (std::uint32_t level = 0; level < halt.depth; ++level) {
        const std::byte* call = halt.root + 8 * (halt.code.calls_slot() + 2 * level);
        levels.push_back({read<std::uint64_t>(call) - 1, read<std::uint64_t>(call + 8)});
    }
    levels.push_back({halt.code.statements[halt.statement].instruction, halt.base});
    return levels;
}

/// Goes along the pile of the scan: what each call that meets itself has put aside stands there,
/// with its record behind, in the order of the calls.
class Pile {
  public:
    Pile(std::byte* root, st::SlotRange slots) : root_(root), next_(slots.first), end_(slots.end) {}

    /// The record of a call that ran on that frame already; null: there is none.
    std::byte* kept(std::uint64_t slots, std::uint64_t address, std::uint64_t running) {
        for (std::uint64_t at = next_; at + slots + st::record_end <= end_; ++at) {
            st::meaning::Frames::Record record;
            std::memcpy(&record, root_ + 8 * (at + slots), sizeof record);
            if (record.slots != slots || record.address != address || record.running != running)
                continue;
            next_ = at + slots + st::record_end;
            return root_ + 8 * at;
        }
        return nullptr;
    }

  private:
    std::byte* root_;
    std::uint64_t next_, end_;
};

/// `frames`: the outermost first, as the levels.
void find_aside(const st::Halt& halt, const std::vector<Level>& levels,
                std::vector<Frame>& frames) {
    Pile pile(halt.root, frames.front().of->pile);
    for (std::size_t i = 1; i < levels.size(); ++i) {
        const Frame& called = frames[i];
        const bool is_kept =
            halt.code.instructions[levels[i - 1].instruction + 1].op == st::Op::swap_frame;
        const auto meets = [&](const Frame& outer) {
            return !outer.aside && outer.base == called.base && outer.of == called.of;
        };
        const auto end = frames.begin() + static_cast<std::ptrdiff_t>(i);
        const auto outer = std::find_if(frames.begin(), end, meets);
        if (!is_kept || outer == end) continue;
        outer->aside = pile.kept(called.of->kept(), levels[i].base, i - 1);
    }
}

}  // namespace

std::byte* Frame::seen(std::byte* at) const {
    for (const Frame* frame = this; frame; frame = frame->outer) {
        std::byte* kept = frame->aside;
        for (const auto& [first, last] : {frame->of->variables, frame->of->temporaries}) {
            std::byte* const begin = frame->base + 8 * std::size_t{first};
            const std::ptrdiff_t bytes = 8 * std::ptrdiff_t{last - first};
            if (at >= begin && at < begin + bytes) return kept ? kept + (at - begin) : at;
            if (kept) kept += bytes;
        }
    }
    return at;
}

bool Frame::sees(std::string_view expression) const {
    const std::string_view first = expression.substr(0, expression.find_first_of(".[^"));
    for (const st::Routine* scope = routine; scope; scope = scope->owner)
        if (st::find_in(scope->names, first)) return true;
    return first.starts_with('%');
}

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
    const std::vector<Level> levels = levels_of(halt);
    std::vector<Frame> frames;
    for (const Level& level : levels) {
        Frame& frame =
            frames.emplace_back(frame_at(halt, made, machine, level.instruction, level.base));
        frame.name = routine_at(made, level.instruction)->name;
        frame.mark = made.generated.code.places[level.instruction].mark();
    }
    frames.back().mark = halt.code.statements[halt.statement].place.mark();
    find_aside(halt, levels, frames);
    std::ranges::reverse(frames);
    for (std::size_t i = 1; i < frames.size(); ++i) frames[i - 1].outer = &frames[i];
    const std::string instance = name_of_instance(machine, halt.root);
    if (!instance.empty()) frames.back().name += fmt::format(" ({})", instance);
    return frames;
}

}  // namespace lineshaft::debug

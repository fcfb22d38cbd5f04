#include "runtime/debug/breakpoints.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

namespace lineshaft::debug {

namespace {

namespace fs = std::filesystem;

std::string whole_path(const std::string& path) {
    std::error_code unknown;
    const fs::path whole = fs::weakly_canonical(path, unknown);
    return unknown ? path : whole.string();
}

}  // namespace

Breakpoints::Breakpoints(const st::Library::Made* made) : made_(made) {
    if (!made) return;
    const st::Code& code = made->generated.code;
    routines_ = code.routines.data();
    std::map<std::string, std::string> whole;
    for (const st::StatementStart& statement : code.statements) {
        const Mark mark = statement.place.mark();
        const auto [path, is_new] = whole.try_emplace(mark.file->path);
        if (is_new) path->second = whole_path(mark.file->path);
        lines_.push_back({path->second, mark.line});
    }
    arrange();
}

std::vector<Breakpoint> Breakpoints::set(const std::string& path,
                                         const std::vector<Wanted>& wanted) {
    const std::string whole = whole_path(path);
    std::erase_if(breakpoints_, [&](const Breakpoint& b) { return b.path == whole; });
    const std::size_t first = breakpoints_.size();
    for (const Wanted& each : wanted) {
        Breakpoint breakpoint{++last_id_, each.line, false, whole, each};
        breakpoint.is_verified = place(breakpoint);
        breakpoints_.push_back(std::move(breakpoint));
    }
    arrange();
    return {breakpoints_.begin() + static_cast<std::ptrdiff_t>(first), breakpoints_.end()};
}

/// False where no statement of the file begins there or behind.
bool Breakpoints::place(Breakpoint& breakpoint) const {
    int nearest = 0;
    for (const Line& line : lines_)
        if (line.path == breakpoint.path && line.line >= breakpoint.wanted.line &&
            (nearest == 0 || line.line < nearest))
            nearest = line.line;
    if (nearest != 0) breakpoint.line = nearest;
    return nearest != 0;
}

/// At the first statement of its line; of several routines in one line at that of each.
void Breakpoints::arrange() {
    if (!made_) return;
    const st::Code& code = made_->generated.code;
    at_.assign(code.statements.size(), {});
    std::vector<bool> has_one(code.routines.size());
    count_ = 0;
    for (const Breakpoint& breakpoint : breakpoints_) {
        std::size_t before = code.routines.size();
        for (std::size_t i = 0; i < lines_.size() && breakpoint.is_verified; ++i) {
            if (lines_[i].line != breakpoint.line || lines_[i].path != breakpoint.path) continue;
            const auto routine = static_cast<std::size_t>(
                std::ranges::upper_bound(code.routines, code.statements[i].instruction, {},
                                         &st::CodeRoutine::end) -
                code.routines.begin());
            if (routine == before) continue;
            before = routine;
            at_[i].push_back(&breakpoint);
            has_one[routine] = true;
            ++count_;
        }
    }
    // Callees stand before their callers; what a call finds by an instance may be any method.
    reached_ = has_one;
    std::map<const st::Routine*, std::size_t> numbers;
    for (std::size_t i = 0; i < code.routines.size(); ++i) {
        const st::Routine& routine = *made_->checked.order[i];
        numbers.emplace(&routine, i);
        if (made_->checked.dispatches) reached_[i] = count_ > 0;
        for (const st::Routine* called : routine.calls)
            if (const auto it = numbers.find(called); it != numbers.end() && reached_[it->second])
                reached_[i] = true;
    }
}

}  // namespace lineshaft::debug

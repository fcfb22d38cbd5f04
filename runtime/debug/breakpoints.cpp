#include "runtime/debug/breakpoints.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace lineshaft::debug {

namespace {

namespace fs = std::filesystem;

std::string whole_path(const std::string& path) {
    std::error_code unknown;
    const fs::path whole = fs::weakly_canonical(path, unknown);
    return unknown ? path : whole.string();
}

std::shared_ptr<const Expression> read_expression(const std::string& text, Breakpoint& to) {
    if (text.empty()) return {};
    auto expression = std::make_shared<const Expression>(text, *to.file);
    if (!expression->error().empty()) to.error = fmt::format("'{}': {}", text, expression->error());
    return expression;
}

std::optional<HitCount> read_hits(std::string_view text, std::string& error) {
    using Is = HitCount::Is;
    constexpr std::pair<std::string_view, Is> signs[] = {
        {">=", Is::at_least}, {">", Is::above}, {"%", Is::multiple}, {"=", Is::equal}};
    const auto trim = [&] {
        text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    };
    trim();
    if (text.empty()) return {};
    HitCount hits;
    for (const auto& [sign, is] : signs)
        if (text.starts_with(sign)) {
            hits.is = is;
            text.remove_prefix(sign.size());
            break;
        }
    trim();
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), hits.number);
    if (wrong != std::errc() || end != text.data() + text.size() || hits.number < 1)
        error = "write 3, >= 3, > 3 or % 3 for how often it is come to";
    return hits;
}

/// `{x}` is the value of x, `{{` and `}}` are the braces themselves.
void read_log(Breakpoint& to) {
    std::string_view rest = to.wanted.log;
    std::string text;
    while (!rest.empty()) {
        const char c = rest.front();
        const bool is_brace = rest.size() > 1 && rest[1] == c && (c == '{' || c == '}');
        const std::size_t close = c == '{' && !is_brace ? rest.find('}') : rest.npos;
        if (close == rest.npos) {
            text += c;
            rest.remove_prefix(is_brace ? 2 : 1);
            continue;
        }
        to.log.emplace_back(std::exchange(text, {}),
                            read_expression(std::string(rest.substr(1, close - 1)), to));
        rest.remove_prefix(close + 1);
    }
    if (!text.empty()) to.log.emplace_back(std::move(text), nullptr);
}

}  // namespace

bool HitCount::holds(std::int64_t count) const {
    switch (is) {
        case Is::equal:
            return count == number;
        case Is::at_least:
            return count >= number;
        case Is::above:
            return count > number;
        case Is::multiple:
            return count % number == 0;
    }
    return true;
}

std::string Breakpoint::logged(const Frame& frame) const {
    std::string text;
    for (const auto& [before, expression] : log) {
        text += before;
        if (!expression) continue;
        const Evaluated value = expression->value(frame);
        text += value.error.empty() ? value.shown.value : "<" + value.error + ">";
    }
    return text + "\n";
}

bool Breakpoints::are_counted() const {
    return std::ranges::any_of(breakpoints_,
                               [](const Breakpoint& b) { return b.hits.has_value(); });
}

Breakpoints::Breakpoints(const st::Library::Made* made) : made_(made) {
    if (!made) return;
    const st::Code& code = made->generated.code;
    routines_ = code.routines.data();
    std::map<std::string, std::string> whole;
    for (const st::StatementStart& statement : code.statements) {
        const Mark mark = statement.place.mark();
        const auto [path, is_new] = whole.try_emplace(mark.file->path);
        if (is_new) path->second = whole_path(mark.file->path);
        lines_.push_back({path->second, mark.file, mark.line});
    }
    arrange();
}

std::vector<Breakpoint> Breakpoints::set(const std::string& path,
                                         const std::vector<Wanted>& wanted) {
    const std::string whole = whole_path(path);
    std::erase_if(breakpoints_, [&](const Breakpoint& b) { return b.path == whole; });
    const std::size_t first = breakpoints_.size();
    for (const Wanted& each : wanted) {
        Breakpoint breakpoint{.id = ++last_id_, .line = each.line, .path = whole, .wanted = each};
        if (place(breakpoint)) {
            breakpoint.condition = read_expression(each.condition, breakpoint);
            breakpoint.hits = read_hits(each.hits, breakpoint.error);
            read_log(breakpoint);
        } else {
            breakpoint.error =
                "no statement of the program's Structured Text begins here or behind";
        }
        breakpoint.is_verified = breakpoint.error.empty();
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
            nearest = line.line, breakpoint.file = line.file;
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
    // Callees stand before their callers, but in a ring; what a call finds by an instance may be
    // any method.
    reached_ = has_one;
    std::map<const st::Routine*, std::size_t> numbers;
    for (std::size_t i = 0; i < code.routines.size(); ++i) {
        const st::Routine& routine = *made_->checked.order[i];
        numbers.emplace(&routine, i);
        if (made_->checked.dispatches || routine.ring != 0) reached_[i] = count_ > 0;
        for (const st::Called& called : routine.calls)
            if (const auto it = numbers.find(called.routine);
                it != numbers.end() && reached_[it->second])
                reached_[i] = true;
    }
}

}  // namespace lineshaft::debug

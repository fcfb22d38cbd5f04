#include "runtime/source/diagnostic.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft {
namespace {

constexpr std::size_t longest_line = 100;      // characters of source shown
constexpr std::size_t before_mark = 40;        // of these, when the line is cut at its start
constexpr std::size_t longest_message = 1000;  // characters; a message quotes the user's text
constexpr std::size_t longest_word = 100;      // bytes that `nearest` compares
constexpr std::size_t most_kept = 1000;        // diagnostics
constexpr std::size_t most_names = 12;
constexpr std::size_t most_meant = 3, most_edits = 3;
constexpr std::size_t shortest_abbreviation = 3;
constexpr std::string_view cut = "...";

/// Line breaks, and characters that reorder or hide what stands around them.
bool is_unsafe(char32_t code) {
    if (is_control(code) || code == 0xFEFF) return true;
    if (code == 0x061C || code == 0x200E || code == 0x200F) return true;
    return (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

/// The beginning of a text as it is printed.
struct Printable {
    std::string text;
    std::size_t characters = 0;
    bool whole = false;  ///< there is no more of it
};

Printable printable(std::string_view text, std::size_t most) {
    const std::size_t plain = std::min(plain_length(text), most);
    Printable out{.text = std::string(text.substr(0, plain)), .characters = plain};
    text.remove_prefix(plain);
    for (; !text.empty() && out.characters < most; ++out.characters) {
        const Utf8Character character = first_character(text);
        if (text.front() == '\t')
            out.text += ' ';
        else if (!character.valid || is_unsafe(character.code))
            out.text += '?';
        else
            out.text += text.substr(0, character.bytes);
        text.remove_prefix(character.bytes);
    }
    out.whole = text.empty();
    return out;
}

/// Removes `count` characters, or all there are, from the beginning; how many that were.
std::size_t skip(std::string_view& text, std::size_t count) {
    std::size_t skipped = std::min(plain_length(text), count);
    text.remove_prefix(skipped);
    for (; skipped < count && !text.empty(); ++skipped)
        text.remove_prefix(first_character(text).bytes);
    return skipped;
}

std::string printable_text(std::string_view text) {
    Printable shown = printable(text, longest_message);
    if (!shown.whole) shown.text += cut;
    return std::move(shown.text);
}

/// Without what is never printed.
std::string kept(std::string text) {
    constexpr std::size_t most_bytes = 4;  // of a character
    if (text.size() <= most_bytes * longest_message) return text;
    std::string_view rest = text;
    skip(rest, longest_message + 1);
    text.resize(text.size() - rest.size());
    return text;
}

/// Line `line` without its end; empty beyond the last.
std::string_view line_of(const SourceFile& file, int line) {
    std::string_view text = file.text;
    if (text.starts_with(utf8_byte_order_mark)) text.remove_prefix(utf8_byte_order_mark.size());
    for (int i = file.first_line; i < line; ++i) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return {};
        text.remove_prefix(end + 1);
    }
    text = text.substr(0, text.find('\n'));
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
}

/// What is shown of a line, and where in it (from 0) the mark begins and ends.
struct Window {
    std::string text;
    std::size_t begin = 0;
    std::size_t end = 0;
};

Window window_of(std::string_view line, const Mark& mark) {
    std::string_view rest = line;
    const std::size_t column = skip(rest, static_cast<std::size_t>(std::max(mark.column, 1)) - 1);
    const std::size_t length = static_cast<std::size_t>(std::max(mark.length, 1));
    Printable shown = printable(line, longest_line);
    const std::size_t first = shown.whole || column <= before_mark ? 0 : column - before_mark;
    if (first > 0) {
        skip(line, first);
        shown = printable(line, longest_line);
    }
    const std::string_view left = first > 0 ? cut : "";
    const std::size_t begin = column - first;
    const std::size_t end = std::max(begin + 1, std::min(begin + length, shown.characters));
    return {fmt::format("{}{}{}", left, shown.text, shown.whole ? "" : cut), begin + left.size(),
            end + left.size()};
}

std::string snippet(const Diagnostic& diagnostic) {
    const Mark& mark = diagnostic.mark;
    const Window window = window_of(line_of(*mark.file, mark.line), mark);
    const std::string number = fmt::format("{:>4}", mark.line);
    const std::string help = printable_text(diagnostic.help);
    return fmt::format("{} |{}{}\n{:{}} | {:{}}^{:~<{}}{}{}\n", number,
                       window.text.empty() ? "" : " ", window.text, "", number.size(), "",
                       window.begin, "", window.end - window.begin - 1, help.empty() ? "" : " ",
                       help);
}

std::string_view path_of(const Diagnostic& diagnostic) {
    const Mark& mark = diagnostic.mark;
    return mark.file ? std::string_view(mark.file->path) : std::string_view();
}

auto order(const Diagnostic& d) {
    return std::make_tuple(path_of(d), d.mark.line, d.mark.column, std::string_view(d.code),
                           std::string_view(d.message));
}

/// Optimal string alignment: insert, remove, replace, exchange of two neighbours cost 1 each.
std::size_t distance(std::string_view a, std::string_view b) {
    using Row = std::array<std::size_t, longest_word + most_edits + 1>;
    Row rows[3];
    auto &before_last = rows[0], &last = rows[1], &row = rows[2];
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
            const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (exchanged) row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
        std::swap(before_last, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

/// Which letters it has, small ones for capitals: of two words that differ in so many, at least as
/// many edits make the one of the other.
std::uint64_t letters_of(std::string_view word) {
    std::uint64_t letters = 0;
    for (const char c : word) letters |= std::uint64_t{1} << (static_cast<unsigned>(lower(c)) & 63);
    return letters;
}

int least_edits(std::uint64_t a, std::uint64_t b) {
    return std::max(std::popcount(a & ~b), std::popcount(b & ~a));
}

bool begins_with(std::string_view word, std::string_view name) {
    return word.size() >= name.size() &&
           std::equal(name.begin(), name.end(), word.begin(),
                      [](char a, char b) { return lower(a) == lower(b); });
}

/// `pos` position, and not `master` master_unit.
bool abbreviates(std::string_view word, std::string_view name) {
    return word.size() >= shortest_abbreviation && word.size() < name.size() &&
           begins_with(name, word) && name.find('_', word.size()) == std::string_view::npos;
}

/// `GearInPosition` is GearInPos, which is most of it.
bool spells_out(std::string_view word, std::string_view name) {
    return begins_with(word, name) && 3 * name.size() >= 2 * word.size();
}

/// The length of the longest part of a name: 8 for `a.position`.
std::size_t longest_part(std::string_view word) {
    const std::size_t dot = std::min(word.find('.'), word.size());
    return std::max(dot, word.size() - dot);
}

}  // namespace

Mark mark_of(const std::shared_ptr<const SourceFile>& file, std::size_t begin, std::size_t end) {
    std::string_view text = file->text;
    const std::size_t whole = text.size();
    Mark from{file, 1, 1, 1};
    std::size_t first = text.starts_with(utf8_byte_order_mark) ? utf8_byte_order_mark.size() : 0;
    if (!file->excerpts.empty()) {
        const auto next =
            std::ranges::upper_bound(file->excerpts, begin, std::less<>(), &Excerpt::begin);
        const Excerpt& excerpt = *std::prev(next);
        if (!excerpt.is_copied) return excerpt.place;
        first = excerpt.begin;
        from = excerpt.place;
        end = std::min(end, next == file->excerpts.end() ? whole : next->begin);
    }
    begin = std::max(begin, first);
    const std::string_view marked = text.substr(begin, std::max(end, begin) - begin);
    std::string_view before = text.substr(first, begin - first);
    for (std::size_t i = before.find('\n'); i != before.npos; i = before.find('\n')) {
        ++from.line;
        from.column = 1;
        before.remove_prefix(i + 1);
    }
    from.column += static_cast<int>(count_characters(before));
    const std::string_view shown = marked.substr(0, marked.find('\n'));
    from.length = std::max(1, static_cast<int>(count_characters(shown)));
    return from;
}

void Diagnostics::add(std::string code, Mark mark, std::string message, std::string help) {
    ++count_;
    if (list_.size() < most_kept)
        list_.push_back(
            {std::move(code), std::move(mark), kept(std::move(message)), kept(std::move(help))});
}

void Diagnostics::add(const Diagnostic& found) {
    if (found.is_warning)
        warn(found.code, found.mark, found.message, found.help);
    else
        add(found.code, found.mark, found.message, found.help);
}

bool Diagnostics::keeps_warnings() const {
    return warnings_.size() < most_kept;
}

void Diagnostics::warn(std::string code, Mark mark, std::string message, std::string help) {
    if (!keeps_warnings()) return;
    Diagnostic warning{std::move(code), std::move(mark), kept(std::move(message)),
                       kept(std::move(help)), true};
    const auto is_same = [&](const Diagnostic& other) { return order(other) == order(warning); };
    if (std::ranges::none_of(warnings_, is_same)) warnings_.push_back(std::move(warning));
}

void Diagnostics::be_strict() {
    for (Diagnostic& warning : warnings_) {
        warning.is_warning = false;
        list_.push_back(std::move(warning));
        ++count_;
    }
    warnings_.clear();
}

std::string Diagnostics::render(std::size_t limit) const {
    std::vector<const Diagnostic*> sorted;
    const auto& shown_list = list_.empty() ? warnings_ : list_;
    sorted.reserve(shown_list.size());
    for (const Diagnostic& diagnostic : shown_list) sorted.push_back(&diagnostic);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto* a, const auto* b) { return order(*a) < order(*b); });
    const auto end = std::unique(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) {
        return order(*a) == order(*b);
    });
    sorted.erase(end, sorted.end());

    std::string out;
    const std::size_t shown = std::min(limit, sorted.size());
    for (std::size_t i = 0; i < shown; ++i) out += lineshaft::render(*sorted[i]);
    const std::size_t not_kept = list_.empty() ? 0 : count_ - list_.size();
    if (const std::size_t more = sorted.size() - shown + not_kept; more > 0)
        out += fmt::format("... and {} more\n", more);
    return out;
}

std::string Diagnostic::whole_message() const {
    return mark.drawn ? fmt::format("{} ({})", message, *mark.drawn) : message;
}

std::string render(const Diagnostic& diagnostic) {
    const Mark& mark = diagnostic.mark;
    const bool placed = mark.file && mark.line > 0;
    std::string place;
    if (mark.file) place = printable_text(mark.file->path) + ":";
    if (placed) place += fmt::format("{}:{}:", mark.line, mark.column);
    if (!place.empty()) place += " ";

    std::string out =
        fmt::format("{}{}[{}]: {}\n", place, diagnostic.is_warning ? "warning" : "error",
                    diagnostic.code, printable_text(diagnostic.whole_message()));
    if (placed) {
        out += snippet(diagnostic);
    } else if (!diagnostic.help.empty()) {
        out += fmt::format("     | {}\n", printable_text(diagnostic.help));
    }
    return out;
}

std::vector<std::string> nearest(std::string_view word,
                                 const std::vector<std::string>& candidates) {
    if (word.size() > longest_word) return {};
    const std::string wanted = lower(word);
    std::vector<std::string> near;
    for (const std::string& candidate : candidates)
        if (abbreviates(wanted, candidate)) near.push_back(candidate);
    if (near.size() == 1) return near;
    near.clear();
    for (const std::string& candidate : candidates)
        if (spells_out(wanted, candidate) &&
            (near.empty() || candidate.size() > near.front().size()))
            near = {candidate};
    const std::vector<std::string> spelled_out = std::exchange(near, {});
    std::size_t fewest = std::min(longest_part(word) / 3, most_edits);
    const std::uint64_t letters = letters_of(wanted);
    for (const std::string& candidate : candidates) {
        const std::size_t longer = std::max(candidate.size(), word.size());
        if (longer - std::min(candidate.size(), word.size()) > fewest) continue;
        if (std::cmp_greater(least_edits(letters, letters_of(candidate)), fewest)) continue;
        if (std::ranges::find(near, candidate) != near.end()) continue;
        const std::size_t edits = distance(wanted, lower(candidate));
        if (edits > fewest || edits >= longer) continue;
        if (edits < fewest) near.clear();
        fewest = edits;
        if (near.size() < most_meant) near.push_back(candidate);
    }
    return near.empty() ? spelled_out : near;
}

std::string suggest(std::string_view word, const std::vector<std::string>& candidates,
                    std::string_view before) {
    std::string meant;
    for (const std::string& name : nearest(word, candidates))
        meant += fmt::format("{}'{}{}'", meant.empty() ? "" : " or ", before, name);
    if (!meant.empty()) return fmt::format("did you mean {}?", meant);
    if (candidates.empty()) return {};
    const auto end = std::next(
        candidates.begin(), static_cast<std::ptrdiff_t>(std::min(candidates.size(), most_names)));
    return fmt::format("known: {}{}", fmt::join(candidates.begin(), end, ", "),
                       candidates.size() > most_names ? ", ..." : "");
}

}  // namespace lineshaft

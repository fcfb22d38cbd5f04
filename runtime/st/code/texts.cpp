#include <algorithm>
#include <string>

#include "runtime/st/code/code.hpp"
#include "runtime/st/code/meaning.hpp"

namespace lineshaft::st::meaning {

std::string_view text_at(const std::byte* place) {
    return {reinterpret_cast<const char*>(place + 8), static_cast<std::size_t>(word(place, 0))};
}

bool copy_text(std::byte* to, const std::byte* from, TextRoom room) {
    const std::uint64_t whole = word(from, 0), length = kept_bytes(text_at(from), room);
    std::memmove(to + 8, from + 8, length);
    set_word(to, 0, length);
    if (length == room.most() && !room.counts_units()) set_byte(to + 8, length, 0);
    return length == whole;
}

void recode_text(std::byte* to, const std::byte* from, TextRoom room) {
    const std::string text = room.counts_units() ? widened(text_at(from)) : narrowed(text_at(from));
    const std::size_t kept = kept_bytes(text, room);
    std::memcpy(to + 8, text.data(), kept);
    set_word(to, 0, kept);
}

/// As `append_text`: first and count are of units.
static bool append_units(std::byte* to, const std::byte* from, std::int64_t first,
                         std::int64_t count, TextRoom room) {
    const std::u16string units = units_of(text_at(from));
    const auto length = static_cast<std::int64_t>(units.size());
    first = std::clamp<std::int64_t>(first, 0, length);
    count = std::clamp<std::int64_t>(count, 0, length - first);
    const auto taken = static_cast<std::size_t>(count);
    const std::string text =
        std::string(text_at(to)) +
        text_of_units(std::u16string_view(units).substr(static_cast<std::size_t>(first), taken));
    const std::size_t kept = kept_bytes(text, room);
    std::memcpy(to + 8, text.data(), kept);
    set_word(to, 0, kept);
    return kept == text.size();
}

bool is_too_long(const std::byte* text, TextRoom room) {
    return kept_bytes(text_at(text), room) < word(text, 0);
}

std::uint64_t length_of_text(const std::byte* text, bool in_units) {
    return in_units ? count_units(text_at(text)) : word(text, 0);
}

bool append_text(std::byte* to, const std::byte* from, std::int64_t first, std::int64_t count,
                 TextRoom room) {
    if (room.counts_units()) return append_units(to, from, first, count, room);
    const auto length = static_cast<std::int64_t>(word(from, 0));
    first = std::clamp<std::int64_t>(first, 0, length);
    count = std::clamp<std::int64_t>(count, 0, length - first);
    const auto before = static_cast<std::int64_t>(word(to, 0));
    const auto taken = std::clamp<std::int64_t>(room.most() - before, 0, count);
    std::memmove(to + 8 + before, from + 8 + first, static_cast<std::size_t>(taken));
    set_word(to, 0, static_cast<std::uint64_t>(before + taken));
    return taken == count;
}

std::int64_t compare_texts(const std::byte* a, const std::byte* b) {
    const auto order = text_at(a) <=> text_at(b);
    return order < 0 ? -1 : order > 0;
}

std::optional<std::uint64_t> character_of(const std::byte* from, std::int64_t place,
                                          TextRoom room) {
    const bool is_there = place >= 1 && place <= std::int64_t{room.most()};
    if (!is_there) return room.may_miss() ? std::optional<std::uint64_t>(0) : std::nullopt;
    if (room.counts_units()) return byte_of_text(from, place - 1, room);
    const auto at = static_cast<std::uint64_t>(place - 1);
    return at < word(from, 0) ? byte(from + 8, at) : 0;
}

static bool set_unit(std::byte* text, std::uint64_t at, std::uint64_t value, std::uint64_t most) {
    if (at > most || (at == most && value != 0)) return false;
    std::u16string memory = memory_of_units(text, most);
    memory[at] = static_cast<char16_t>(value);
    set_memory_of_units(text, memory);
    return true;
}

static bool set_or_append(std::byte* text, std::int64_t place, std::uint64_t value, TextRoom room) {
    const std::uint64_t at = static_cast<std::uint64_t>(place) - 1,
                        length = length_of_text(text, room.counts_units());
    if (at > length || at >= room.most()) return true;
    if (room.counts_units()) return set_unit(text, at, value, room.most());
    set_byte(text + 8, at, value);
    if (at == length) set_word(text, 0, length + 1);
    if (at == length && at + 1 == room.most()) set_byte(text + 8, at + 1, 0);
    return true;
}

bool set_character(std::byte* text, std::int64_t place, std::uint64_t value, TextRoom room) {
    if (room.may_miss()) return set_or_append(text, place, value, room);
    const auto at = static_cast<std::uint64_t>(place) - 1;
    if (room.grows() && at == length_of_text(text, room.counts_units()) && at < room.most())
        return set_or_append(text, place, value, room);
    if (room.counts_units())
        return at < count_units(text_at(text)) && set_unit(text, at, value, room.most());
    const bool is_there = at < word(text, 0);
    if (is_there) set_byte(text + 8, at, value);
    if (is_there && value == 0) set_word(text, 0, at);
    return is_there;
}

std::optional<std::uint64_t> byte_of_text(const std::byte* from, std::int64_t place,
                                          TextRoom room) {
    const auto at = static_cast<std::uint64_t>(place);
    if (at > room.most()) return {};
    if (room.counts_units()) {
        const std::u16string units = units_of(text_at(from));
        return at < units.size() ? units[at] : 0;
    }
    return at < word(from, 0) ? byte(from + 8, at) : 0;
}

bool set_byte_of_text(std::byte* text, std::int64_t place, std::uint64_t value, TextRoom room) {
    const auto at = static_cast<std::uint64_t>(place);
    if (room.counts_units()) return set_unit(text, at, value, room.most());
    if (at > room.most() || (at == room.most() && value != 0)) return false;
    std::uint64_t length = word(text, 0);
    const bool is_behind = at >= length;
    if (is_behind && length < room.most()) set_byte(text + 8, length, 0);
    if (at < room.most()) set_byte(text + 8, at, value);
    if (!is_behind && value == 0) length = at;
    while (is_behind && length < room.most() && byte(text + 8, length) != 0) ++length;
    set_word(text, 0, length);
    return true;
}

std::uint64_t find_text(const std::byte* in, const std::byte* what, bool in_units) {
    const std::size_t at =
        text_at(what).empty() ? text_at(in).npos : text_at(in).find(text_at(what));
    if (at == text_at(in).npos) return 0;
    return (in_units ? count_units(text_at(in).substr(0, at)) : at) + 1;
}

}  // namespace lineshaft::st::meaning

#include "runtime/st/types/wide_text.hpp"

#include <algorithm>
#include <cstring>

#include "runtime/source/utf8.hpp"

namespace lineshaft::st {

namespace {

constexpr char32_t first_half = 0xD800, second_half = 0xDC00, end_of_halves = 0xE000;

/// Half of a character, as three bytes.
Utf8Character first_half_of(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (text.size() < 3 || byte(0) != 0xED || byte(1) < 0xA0 || (byte(1) & 0xC0) != 0x80 ||
        (byte(2) & 0xC0) != 0x80)
        return {byte(0), 1, false};
    return {first_half | (byte(1) & 0x1FU) << 6 | (byte(2) & 0x3FU), 3, true};
}

Utf8Character next_of(std::string_view text) {
    const Utf8Character next = first_character(text);
    return next.valid ? next : first_half_of(text);
}

std::size_t units_in(char32_t code) {
    return code > 0xFFFF ? 2 : 1;
}

}  // namespace

std::u16string units_of(std::string_view text) {
    std::u16string units;
    for (; !text.empty(); text.remove_prefix(next_of(text).bytes)) {
        const char32_t code = next_of(text).code;
        if (units_in(code) == 2) {
            units += static_cast<char16_t>(first_half + ((code - 0x10000) >> 10));
            units += static_cast<char16_t>(second_half + ((code - 0x10000) & 0x3FF));
        } else {
            units += static_cast<char16_t>(code);
        }
    }
    return units;
}

std::string text_of_units(std::u16string_view units) {
    std::string text;
    for (std::size_t i = 0; i < units.size(); ++i) {
        const char32_t unit = units[i], next = i + 1 < units.size() ? units[i + 1] : 0;
        const bool are_halves =
            unit >= first_half && unit < second_half && next >= second_half && next < end_of_halves;
        if (are_halves) ++i;
        add_character(
            text, are_halves ? 0x10000 + ((unit - first_half) << 10) + next - second_half : unit);
    }
    return text;
}

std::size_t count_units(std::string_view text) {
    std::size_t count = 0;
    for (; !text.empty(); text.remove_prefix(next_of(text).bytes))
        count += units_in(next_of(text).code);
    return count;
}

std::string narrowed(std::string_view text) {
    std::string bytes;
    for (const char16_t unit : units_of(text)) bytes += unit > 0xFF ? '?' : static_cast<char>(unit);
    return bytes;
}

std::string widened(std::string_view bytes) {
    std::string text;
    for (const char byte : bytes) add_character(text, static_cast<unsigned char>(byte));
    return text;
}

std::size_t kept_bytes(std::string_view text, TextRoom room) {
    if (!room.counts_units()) return std::min<std::size_t>(text.size(), room.most());
    std::size_t kept = 0;
    for (std::size_t left = room.most(); kept < text.size();) {
        const Utf8Character next = next_of(text.substr(kept));
        if (units_in(next.code) > left) break;
        left -= units_in(next.code);
        kept += next.bytes;
    }
    return kept;
}

std::u16string memory_of_units(const std::byte* slots, std::uint64_t length) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, slots, sizeof bytes);
    const std::string_view all(reinterpret_cast<const char*>(slots + sizeof bytes), 3 * length);
    std::u16string memory = units_of(all.substr(0, bytes));
    memory += u'\0';
    if (bytes < all.size()) memory += units_of(all.substr(bytes + 1));
    memory.resize(length + 1);
    memory.back() = 0;
    return memory;
}

void set_memory_of_units(std::byte* slots, std::u16string_view memory) {
    const std::size_t end = memory.find(u'\0');
    std::string text = text_of_units(memory.substr(0, end));
    const std::uint64_t bytes = text.size();
    if (end + 1 < memory.size()) text += '\0' + text_of_units(memory.substr(end + 1));
    std::memcpy(slots, &bytes, sizeof bytes);
    std::memcpy(slots + sizeof bytes, text.data(), std::min(text.size(), 3 * memory.size() - 3));
}

}  // namespace lineshaft::st

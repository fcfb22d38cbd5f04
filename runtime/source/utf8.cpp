#include "runtime/source/utf8.hpp"

#include <array>

namespace lineshaft {
namespace {

constexpr Utf8Character invalid{0xFFFD, 1, false};

std::size_t sequence_length(unsigned char lead) {
    if (lead >= 0xC2 && lead <= 0xDF) return 2;
    if (lead >= 0xE0 && lead <= 0xEF) return 3;
    if (lead >= 0xF0 && lead <= 0xF4) return 4;
    return 0;
}

}  // namespace

Utf8Character first_beyond_ascii(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::size_t length = sequence_length(byte(0));
    if (length == 0 || length > text.size()) return invalid;

    char32_t code = byte(0) & (0x7Fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0u) != 0x80u) return invalid;
        code = (code << 6) | (byte(i) & 0x3Fu);
    }
    constexpr std::array<char32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    if (code < smallest[length] || code > 0x10FFFF || surrogate) return invalid;
    return {code, length, true};
}

void add_character(std::string& to, char32_t code) {
    const auto add = [&](char32_t byte) {
        to += static_cast<char>(static_cast<unsigned char>(byte));
    };
    const auto rest = [&](int shift) { add(0x80U | ((code >> shift) & 0x3FU)); };
    if (code < 0x80) return add(code);
    if (code < 0x800) return add(0xC0U | (code >> 6)), rest(0);
    if (code < 0x10000) return add(0xE0U | (code >> 12)), rest(6), rest(0);
    add(0xF0U | (code >> 18)), rest(12), rest(6), rest(0);
}

std::size_t count_characters(std::string_view text) {
    std::size_t count = plain_length(text);
    for (text.remove_prefix(count); !text.empty(); ++count)
        text.remove_prefix(first_character(text).bytes);
    return count;
}

}  // namespace lineshaft

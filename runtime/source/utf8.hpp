#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lineshaft {

/// One character of a UTF-8 text. A byte that begins no valid sequence (overlong forms, surrogates
/// and code points above U+10FFFF included) is a character of its own, with `valid` false.
struct Utf8Character {
    char32_t code = 0;
    std::size_t bytes = 1;
    bool valid = true;
};

constexpr bool is_ascii(char c) {
    return static_cast<unsigned char>(c) < 0x80;
}

/// Bytes before the first that is not a printable character of ASCII.
inline std::size_t plain_length(std::string_view text) {
    const char *at = text.data(), *const end = at + text.size();
    while (at != end && *at >= ' ' && *at <= '~') ++at;
    return static_cast<std::size_t>(at - text.data());
}

/// The first character of a text whose first byte is not ASCII.
Utf8Character first_beyond_ascii(std::string_view text);

/// The first character of `text`, which is not empty.
inline Utf8Character first_character(std::string_view text) {
    if (!is_ascii(text.front())) return first_beyond_ascii(text);
    return {static_cast<char32_t>(text.front()), 1, true};
}

/// Appends a character in UTF-8.
void add_character(std::string& to, char32_t code);

/// Number of characters.
std::size_t count_characters(std::string_view text);

/// C0 (tab, line feed and carriage return included), DEL and C1.
constexpr bool is_control(char32_t code) {
    return code < 0x20 || (code >= 0x7F && code < 0xA0);
}

/// The byte order mark of UTF-8, which a file may begin with.
inline constexpr std::string_view utf8_byte_order_mark = "\xEF\xBB\xBF";

}  // namespace lineshaft

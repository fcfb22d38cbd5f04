#pragma once

#include <cstddef>
#include <string_view>

namespace lineshaft {

/// One character of a UTF-8 text. A byte that begins no valid sequence (overlong forms, surrogates
/// and code points above U+10FFFF included) is a character of its own, with `valid` false.
struct Utf8Character {
    char32_t code = 0;
    std::size_t bytes = 1;
    bool valid = true;
};

/// The first character of `text`, which is not empty.
Utf8Character first_character(std::string_view text);

/// Number of characters.
std::size_t count_characters(std::string_view text);

/// C0 (tab, line feed and carriage return included), DEL and C1.
bool is_control(char32_t code);

/// The byte order mark of UTF-8, which a file may begin with.
inline constexpr std::string_view utf8_byte_order_mark = "\xEF\xBB\xBF";

}  // namespace lineshaft

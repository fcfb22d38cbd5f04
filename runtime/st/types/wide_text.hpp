#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lineshaft::st {

/// What a WSTRING of CODESYS counts: units of UTF-16, of which a character beyond U+FFFF has two.
/// Its text is kept in UTF-8, as that of a STRING; a byte that is none of UTF-8 is one unit, and so
/// is half of such a character where the other one is missing.
std::u16string units_of(std::string_view text);
std::string text_of_units(std::u16string_view units);
std::size_t count_units(std::string_view text);

/// The same text as that of a STRING whose characters are bytes, ISO 8859-1, and back. What no byte
/// is, is '?'.
std::string narrowed(std::string_view text);
std::string widened(std::string_view bytes);

/// How many bytes of the text a variable keeps that has room for so many units, or bytes.
inline constexpr std::uint32_t of_units = std::uint32_t{1} << 31;  ///< in a number of room
std::size_t kept_bytes(std::string_view text, std::uint64_t room);

/// What the memory of a WSTRING has, which is kept in slots: the units of its text, a 0, and what
/// is left behind it; `length` units and the last 0. And back: the first 0 ends the text.
std::u16string memory_of_units(const std::byte* slots, std::uint64_t length);
void set_memory_of_units(std::byte* slots, std::u16string_view memory);

}  // namespace lineshaft::st

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

/// What a text has room for, and what becomes of what is no character of it. It is as large as the
/// number that an instruction has of it.
class TextRoom {
  public:
    constexpr TextRoom(std::uint32_t most, bool counts_units)
        : number_(counts_units ? most | units : most) {}
    static constexpr TextRoom of_number(std::uint64_t number) {
        return TextRoom(static_cast<std::uint32_t>(number));
    }

    constexpr std::uint32_t number() const { return number_; }
    /// Bytes, or units.
    constexpr std::uint32_t most() const { return number_ & (grown - 1); }
    /// It is a WSTRING's.
    constexpr bool counts_units() const { return (number_ & units) != 0; }
    /// A character right behind the end of the text is put there.
    constexpr bool grows() const { return (number_ & grown) != 0; }
    /// Likewise, and what else is no character of the text is read as 0 and not written.
    constexpr bool may_miss() const { return (number_ & missing) != 0; }

    constexpr TextRoom that_grows() const { return TextRoom(number_ | grown); }
    constexpr TextRoom that_may_miss() const { return TextRoom(number_ | missing); }

  private:
    static constexpr std::uint32_t grown = 1U << 29, missing = 1U << 30, units = 1U << 31;

    explicit constexpr TextRoom(std::uint32_t number) : number_(number) {}

    std::uint32_t number_;
};

/// How many bytes of the text a variable keeps.
std::size_t kept_bytes(std::string_view text, TextRoom room);

/// What the memory of a WSTRING has, which is kept in slots: the units of its text, a 0, and what
/// is left behind it; `length` units and the last 0. And back: the first 0 ends the text.
std::u16string memory_of_units(const std::byte* slots, std::uint64_t length);
void set_memory_of_units(std::byte* slots, std::u16string_view memory);

}  // namespace lineshaft::st

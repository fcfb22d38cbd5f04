#pragma once

#include <optional>
#include <string>

#include <fmt/format.h>

#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// A scalar as the language writes it, from what its slot has: `TRUE`, `5`, `16#FF`, `2.0`,
/// `T#1s500ms`, `Colour#red`.
std::string value_text(const Type& type, std::uint64_t slot);

/// `T#1d2h3m4s5ms6us7ns`
std::string time_literal(std::int64_t nanoseconds);

/// A time that becomes a text. An instruction has it as a number.
struct TimeText {
    Type::Kind kind = Type::Kind::time;
    TimeForm form = TimeForm::plain;
    bool is_unsigned = false;

    constexpr std::uint32_t number() const {
        return static_cast<std::uint32_t>(kind) | static_cast<std::uint32_t>(form) << 8 |
               std::uint32_t{is_unsigned} << 12;
    }
    static constexpr TimeText of_number(std::uint32_t number) {
        return {static_cast<Type::Kind>(number & 0xFF), static_cast<TimeForm>(number >> 8 & 0xF),
                (number >> 12 & 1) != 0};
    }
};

/// Adds it, of a kind with a time. Allocates nothing.
void add_time(fmt::memory_buffer& to, Type::Kind kind, Wide nanoseconds,
              TimeForm form = TimeForm::plain);

/// What stands behind the '#' of a literal of a kind with a time, in ns; empty if it is none.
std::optional<Wide> read_time(std::string_view text, Type::Kind kind);

/// In UTF-8: a byte that belongs to no character of it is one of Windows-1252, `$81` where that has
/// none; `$0A` for a new line.
std::string printable(std::string_view text);

/// `'it$'s'`
std::string text_literal(std::string_view text);

}  // namespace lineshaft::st

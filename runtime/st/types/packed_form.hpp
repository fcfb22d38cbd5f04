#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/st/types/wide_text.hpp"

namespace lineshaft::st {

/// How a scalar is written in packed memory. An instruction has it as a number.
struct PackedFormat {
    enum class Coding : std::uint8_t {
        bit,
        truth,  ///< a byte, of which any but 0 is TRUE
        whole,
        with_sign,
        real,
        clock,   ///< ns of a slot as `scale` ns a unit; s from 1970 to 2106, without a sign
        dated,   ///< likewise, from 1990-01-01 on
        digits,  ///< a moment of 1990 to 2089 as an S7 has it: a digit in each four bits
    };
    Coding coding = Coding::whole;
    std::uint8_t bytes = 1;  ///< 1, 2, 4, 8
    bool is_big = false;     ///< the highest byte comes first
    std::uint8_t scale = 0;  ///< ns, ms, s, days

    constexpr std::uint32_t number() const {
        return static_cast<std::uint32_t>(coding) | std::uint32_t{bytes} << 8 |
               std::uint32_t{is_big} << 16 | std::uint32_t{scale} << 24;
    }
    static constexpr PackedFormat of_number(std::uint32_t number) {
        return {static_cast<Coding>(number & 0xFF), static_cast<std::uint8_t>(number >> 8),
                (number >> 16 & 1) != 0, static_cast<std::uint8_t>(number >> 24)};
    }
};

/// What a slot has, from `bit` of `bytes` on, and back. A number loses the bits that have no room.
std::uint64_t load_packed(const std::byte* bytes, std::uint64_t bit, PackedFormat format);
void store_packed(std::byte* bytes, std::uint64_t bit, PackedFormat format, std::uint64_t value);

/// A text: its characters and a 0, as in C, of a WSTRING in 16 bits each, or as on an S7 its
/// longest and its own length, a byte each, and its characters. An instruction has it as a number.
struct PackedText {
    std::uint16_t length = 0;  ///< the longest
    bool is_s7 = false, is_wide = false;

    constexpr std::uint32_t number() const {
        return length | std::uint32_t{is_wide} << 30 | std::uint32_t{is_s7} << 31;
    }
    constexpr TextRoom room() const { return {length, is_wide}; }
    static constexpr PackedText of_number(std::uint32_t number) {
        return {static_cast<std::uint16_t>(number), number >> 31 != 0, (number >> 30 & 1) != 0};
    }
};

/// To and from its slots: the length, then the characters. What is too long is cut.
void load_packed_text(std::byte* slots, const std::byte* bytes, std::uint64_t bit, PackedText form);
void store_packed_text(std::byte* bytes, std::uint64_t bit, PackedText form,
                       const std::byte* slots);

}  // namespace lineshaft::st

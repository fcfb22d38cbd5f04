#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "runtime/st/code/machine.hpp"

/// The bytes of a variable, as a controller has them, whose values are kept in slots: what a
/// pointer to another type reads and writes, and MEMCPY and its like. Nothing here throws.
namespace lineshaft::st {

/// From a byte of a variable on. A null reference's bytes are 0; those of another one, and of an
/// instance, are not to be had.
struct Bytes {
    std::uint32_t shape = 0;     ///< of the variable
    std::byte* slots = nullptr;  ///< its first one
    std::int64_t first = 0;      ///< byte, which may be outside
};

/// So many of its bytes are those of the variable.
bool is_inside(const Code& code, const Bytes& bytes, std::uint64_t count);

/// `out_of_range`: what would stand there then is no value of its type.
/// `outside_of_variable`: the bytes are not, or not to be had.
Fault read_bytes(const Code& code, const Bytes& from, std::uint64_t count, std::byte* to);

/// As if all were read before the first is written.
Fault copy_bytes(const Code& code, const Bytes& to, const Bytes& from, std::uint64_t count);
/// An instance of which all bytes become 0 has all its variables 0, and refers to nothing.
Fault fill_bytes(const Code& code, const Bytes& to, std::byte value, std::uint64_t count);
/// -1, 0 or 1 in `order`.
Fault compare_bytes(const Code& code, const Bytes& a, const Bytes& b, std::uint64_t count,
                    std::int64_t& order);

/// A scalar of that shape, so many bits behind: as its slot has it.
Fault load_value(const Code& code, const Bytes& from, std::uint64_t bit, std::uint32_t shape,
                 std::uint64_t& value);
Fault store_value(const Code& code, const Bytes& to, std::uint64_t bit, std::uint32_t shape,
                  std::uint64_t value);

/// A text of that shape: `text` has its slots.
Fault load_text(const Code& code, const Bytes& from, std::uint32_t shape, std::byte* text);
Fault store_text(const Code& code, const Bytes& to, std::uint32_t shape, const std::byte* text);

}  // namespace lineshaft::st

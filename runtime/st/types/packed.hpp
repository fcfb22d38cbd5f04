#pragma once

#include <cstdint>
#include <optional>

#include "runtime/st/types/packed_form.hpp"
#include "runtime/st/types/types.hpp"

/// Memory as a controller has it: bytes that several variables may be views of. README.md of
/// runtime/st has the rule.
namespace lineshaft::st {

/// A scalar's form at an address or in packed memory, as the dialect's controllers have it. Empty
/// for what has no packed form: a reference, an enumeration that takes its own numbers alone where
/// these are not 0, 1, 2, ...
std::optional<PackedFormat> packed_format(const Type& type, const Dialect& dialect);

/// Bits that a value takes; 0 for a type without a packed form: an instance, a reference, and what
/// has such parts.
std::uint64_t packed_bits(const Type& type, const Dialect& dialect);

/// From the beginning of one element to that of the next.
std::uint64_t packed_stride(const Type& array, const Dialect& dialect);

/// Where a member begins in its structure [bits].
std::uint64_t packed_offset(const Type& structure, const Variable& member, const Dialect& dialect);

PackedText packed_text(const Type& text, const Dialect& dialect);

}  // namespace lineshaft::st

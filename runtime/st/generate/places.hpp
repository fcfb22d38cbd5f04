#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// Where a value is.
struct Location {
    enum class Mode : std::uint8_t {
        slot,     ///< slot
        indexed,  ///< slot + what is in `index`
        address,  ///< what the address in slot `index` says, + offset
    };
    Mode mode = Mode::slot;
    Slot slot = 0, index = 0;
    std::uint32_t offset = 0;
    std::optional<std::uint32_t> byte = {};  ///< of a boolean in an instance of the catalogue
    struct Packed {
        std::uint32_t first = 0;  ///< bit
        Slot index = none;        ///< a slot with so many bits more; or none
        const Dialect* dialect = nullptr;
        const Type* type = nullptr;
        bool is_bit = false;  ///< a boolean at an address, `%IX0.3`
        Slot through = none;  ///< a reference: of the bytes of what that is to
    };
    std::optional<Packed> packed = {};  ///< of the bytes from there on
    Slot capacity = none;               ///< of a text of any length: what it holds is in that slot
};

using Mode = Location::Mode;

Location locate(Writing& w, const Expression& e);
Location locate_global(Writing& w, const Variable& variable);
Location part(Writing& w, Location of, const Variable& member);
/// Of the array at `of`, the one that `e` indexes.
Location element(Writing& w, Location of, const Expression& e);
Location behind(Location of, std::uint32_t slots);  ///< so many slots on
/// So far on as will be known when all is laid out.
Location behind(Writing& w, const Location& of, Writing::Late distance);
Location as_address(Writing& w, Location location);
Slot address_of(Writing& w, Location location);

/// How many characters a text holds.
Slot capacity_of(Writing& w, const Location& text, const Type& type);

/// Scalars; `load` gives the slot that a value is in, if it is in one.
Slot load(Writing& w, const Location& from, Slot wanted = none);
void store(Writing& w, const Location& to, Slot from);
/// Bits as the operand of `get_bits` and `set_bits`.
constexpr Slot packed(BitRange bits) {
    return bits.first | Slot{bits.count} << 6;
}
void store_bits(Writing& w, const Expression& target, Slot bits);

/// Slots as they are.
void copy(Writing& w, const Location& to, const Location& from, std::uint32_t slots);

/// A value of the type, of which any may be packed.
void copy_value(Writing& w, const Location& to, const Location& from, const Type& type);

/// Any value.
void assign(Writing& w, const Location& to, const Type& type, const Expression& from);

}  // namespace lineshaft::st

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
Location locate_variable(Writing& w, const Variable& variable);
Location part(Writing& w, Location of, const Variable& member);
/// The element of the array at `of` that `e` indexes.
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

// references.cpp

/// The first of the three slots that a reference is in.
Slot reference(Writing& w, const Expression& e);
/// That of where `place` is.
Slot reference_to(Writing& w, const Expression& place);
/// That of a variable of the routine that is written.
Slot reference_to(Writing& w, const Variable& variable);
/// What `e^` is.
Location locate_target(Writing& w, const Expression& e);
/// The instance that the reference at `from` is to.
Location locate_instance(Writing& w, const Location& from, const Type& instance);
/// `e` is an element of an array that a reference is to and that is not seen by bytes.
bool is_element_of_target(const Expression& e);
/// There may be fewer elements of that array than its type says.
Location locate_element_of_target(Writing& w, const Expression& e);
/// -1, 0 or 1: two references are equal, or the one is before the other.
Slot compare_references(Writing& w, const Expression& e);
/// `p - q`, in bytes.
Slot reference_distance(Writing& w, const Expression& e, Slot wanted);

/// Where it points as a number: bytes, of which a slot has 8, and the instance above 2^35.
Slot address_number(Writing& w, const Expression& e);

/// The number of a type's shape. What it is made of is known when all routines are written.
std::uint32_t shape_number(Writing& w, const Type& type, bool is_s7 = false);
void finish_shapes(Writing& w);

// packed.cpp

/// A value of a type that is packed wherever it is, a UNION's, as one whose parts may be asked for.
Location as_packed(Writing& w, const Location& of, const Type& type);

/// A variable in the process image.
Location locate_in_image(Writing& w, const Variable& variable);

/// What a reference, in three slots, is to, as the bytes that a controller has there.
Location locate_through(Slot reference, const Type& type, const Dialect& dialect);
/// The reference to it.
Slot reference_to_packed(Writing& w, const Location& at);
/// A value that is packed, in slots of its own.
Location unpacked(Writing& w, const Location& at, const Type& type);

/// Parts of what is packed.
Location packed_member(Location of, const Variable& member);
Location packed_element(Writing& w, Location of, const Expression& e);

/// Scalars.
Slot load_packed(Writing& w, const Location& from, Slot wanted);
void store_packed(Writing& w, const Location& to, Slot from);

/// Bytes of a UNION that a slot has room for.
struct RawBytes {
    std::uint64_t first = 0;
    std::uint8_t bytes = 1;
};
std::vector<RawBytes> raw_parts(const Type& of_union);
Slot load_raw(Writing& w, const Location& from, RawBytes part);

/// Texts, between packed memory and what `text` is the address of.
Slot load_packed_text(Writing& w, const Location& from);
void store_packed_text(Writing& w, const Location& to, Slot text);

/// Scalar by scalar, where one of both is packed, or both are.
void copy_packed(Writing& w, const Location& to, const Location& from, const Type& type);

/// The bytes of a value's slots in packed memory.
void fill_packed(std::byte* bytes, std::uint64_t bit, const Type& type, const Dialect& dialect,
                 const std::uint64_t* slots);

/// What the variables of the process image begin with.
void fill_process_image(Writing& w, Writing::Image& image);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/generate/places.hpp"

namespace lineshaft::st {

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

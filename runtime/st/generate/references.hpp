#pragma once

#include "runtime/st/generate/places.hpp"

namespace lineshaft::st {

inline constexpr std::uint32_t reference_slots = 3;

/// The first of the three slots that a reference is in.
Slot reference(Writing& w, const Expression& e);
/// That of where `place` is.
Slot reference_to(Writing& w, const Expression& place);
/// What `e^` is.
Location locate_target(Writing& w, const Expression& e);
/// -1, 0 or 1: two references are equal, or the one is before the other.
Slot compare_references(Writing& w, const Expression& e);
/// `p - q`, in bytes.
Slot reference_distance(Writing& w, const Expression& e, Slot wanted);

/// Where it points as a number: bytes, of which a slot has 8, and the instance above 2^35.
Slot address_number(Writing& w, const Expression& e);

/// The number of a type's shape. What it is made of is known when all routines are written.
std::uint32_t shape_number(Writing& w, const Type& type, bool is_s7 = false);
void finish_shapes(Writing& w);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/generate/places.hpp"

namespace lineshaft::st {

/// A variable in the process image.
Location locate_in_image(Writing& w, const Variable& variable);

/// Parts of what is packed.
Location packed_member(Location of, const Variable& member);
Location packed_element(Writing& w, Location of, const Expression& e);

/// Scalars.
Slot load_packed(Writing& w, const Location& from, Slot wanted);
void store_packed(Writing& w, const Location& to, Slot from);

/// Scalar by scalar, where one of both is packed, or both are.
void copy_packed(Writing& w, const Location& to, const Location& from, const Type& type);

/// What the variables of the process image begin with.
void fill_process_image(Writing& w, Writing::Image& image);

}  // namespace lineshaft::st

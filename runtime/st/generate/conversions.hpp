#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// Of `?=`: where the instance is, or 0 if it is not of the type.
Slot attempted(Writing& w, const Expression& e, Slot wanted);

/// An expression that is a conversion.
Slot converted(Writing& w, const Expression& e, Slot wanted);

/// A number, a time or a boolean in `slot` as one of another type; a real one is rounded, or cut.
Slot convert(Writing& w, Slot slot, const Type& from, const Type& to, bool truncates, Slot wanted);

}  // namespace lineshaft::st

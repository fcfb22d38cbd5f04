#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// The slot that has the value: `wanted` if something had to be computed, else where it is.
Slot value(Writing& w, const Expression& e, Slot wanted = none);
void value_to(Writing& w, const Expression& e, Slot to);

/// A value that stays what it is while `later` is computed: operands go from left to right.
Slot value_before(Writing& w, const Expression& e, const Expression& later);

/// The slot again; a number that is not of its type is a fault.
Slot within(Writing& w, const Type& type, Slot slot);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/syntax/tree.hpp"
#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// `udint - int`, which is a LINT here because signs differ, for a type of 32 bits; so is what MIN,
/// SEL and their like give of both.
bool narrows_mixed_signs(const Expression& e, const Type& from, const Type& to);

}  // namespace lineshaft::st

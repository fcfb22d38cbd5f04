#pragma once

#include "runtime/st/syntax/tree.hpp"
#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// `udint - int`, which is a LINT here because signs differ, for a type of 32 bits; so is what MIN,
/// SEL and their like give of both.
bool narrows_mixed_signs(const Expression& e, const Type& from, const Type& to);

/// What two types are reckoned in; null if there is nothing. Where one integer has a sign and the
/// other has none, and one of them has 32 bits or more, CODESYS takes the signed one of the wider.
const Type* met_type(const Type& a, const Type& b, const Place& place);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// What the call of a standard function gives; null, and told, if its arguments do not suit. They
/// have their own types already, and become what the function takes.
const Type* standard_type_of(Checking& c, Expression*& e, const Type* expected);

}  // namespace lineshaft::st

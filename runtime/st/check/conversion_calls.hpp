#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// `INT_TO_REAL(x)`, `TO_REAL(x)`, `REAL_TRUNC_INT(x)`: a conversion stands for the call then.
/// Empty if the name is none of one.
std::optional<const Type*> check_conversion(Checking& c, Expression*& e, std::string_view name);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// `INT_TO_REAL(x)`, `TO_REAL(x)`, `REAL_TRUNC_INT(x)`: the call becomes a conversion. Empty if the
/// name is none of one.
std::optional<const Type*> check_conversion(Checking& c, Expression& call, std::string_view name);

}  // namespace lineshaft::st

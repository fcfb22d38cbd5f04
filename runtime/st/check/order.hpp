#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// The routine runs, or is made of, what is in `type`.
void depend(Checking& c, const Type* type, Place place);

/// Each behind all that it runs, in `Checked::order`; tells recursions.
void order_routines(Checking& c);
void warn_of_unused(Checking& c);

}  // namespace lineshaft::st

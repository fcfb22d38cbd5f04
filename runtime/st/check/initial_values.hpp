#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Of all variables, and what stands behind BEGIN of data blocks.
void check_initial_values(Checking& c);
/// What the variable begins with; of `a, b : INT := 2 + 3` it is checked once for all.
void check_initial(Checking& c, Variable& variable);
/// A literal, a list or another constant for a variable of `type`. The pointer goes to what it is
/// then.
void check_initial(Checking& c, Expression*& value, const Type& type);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// `x AT %QW4 : INT`: the variable is a view of the process image. One at `%I*` is none.
void locate_in_image(Checking& c, Variable& variable, const Declaration& declared);

/// `%QW4` in an expression.
const Type* check_direct(Checking& c, Expression& e);

/// How long each area is. Warns of variables of which none is a part of the other.
void finish_image(Checking& c);

}  // namespace lineshaft::st

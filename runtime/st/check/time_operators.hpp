#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Operands that are DTL become LDT.
void become_moments(Checking& c, Expression& e);
/// TIME + TIME, TIME * number, TIME / number.
const Type* check_time_arithmetic(Checking& c, Expression*& e);

/// DTL + TIME, TIME + DTL, DTL - TIME, and DTL - DTL, a TIME.
const Type* check_dtl_arithmetic(Checking& c, Expression*& e);

}  // namespace lineshaft::st

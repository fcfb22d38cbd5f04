#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

const Type* check_unary(Checking& c, Expression*& e, const Type* expected);
const Type* check_binary(Checking& c, Expression*& e, const Type* expected);

}  // namespace lineshaft::st

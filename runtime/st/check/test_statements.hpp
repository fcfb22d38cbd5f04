#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A variable, a member or an element.
bool is_place(const Expression& e);
const Type* check_test_statement(Checking& c, Expression& call, bool as_statement);

}  // namespace lineshaft::st

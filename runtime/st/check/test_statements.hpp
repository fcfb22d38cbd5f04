#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A variable, a member or an element.
bool is_place(const Expression& e);
/// ASSERT_EQ and the others of TestCall, which is noted: their arguments, and that they stand in a
/// TEST, L0914. Null: they have no value.
const Type* check_test_statement(Checking& c, Expression& call, bool as_statement);

}  // namespace lineshaft::st

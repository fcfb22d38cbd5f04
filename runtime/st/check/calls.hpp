#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A function or a method is called, which its arguments are checked for and given to; notes the
/// routine, and that the one at hand calls it. The type of its result: null where it has none,
/// which is told unless the call is a statement.
const Type* check_routine_call(Checking& c, Expression*& e, Routine& routine, bool as_statement);
/// The name of a part of a kind of the catalogue, also where vendors call it otherwise: RESET is R.
std::string_view standard_name(const Type& type, std::string_view name);
/// Finds what is called, an instance, a method, a function, a statement of tests, and checks that.
/// `as_statement`: its value is not taken. `expected` as in check().
const Type* check_call(Checking& c, Expression*& e, bool as_statement, const Type* expected);

}  // namespace lineshaft::st

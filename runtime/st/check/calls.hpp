#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

const Type* check_routine_call(Checking& c, Expression*& e, Routine& routine, bool as_statement);
/// The standard's name of a part of its function blocks that CODESYS calls otherwise: RESET is R.
std::string_view standard_name(const Type& type, std::string_view name);
/// Of whatever is called. `as_statement`: its value is not taken.
const Type* check_call(Checking& c, Expression*& e, bool as_statement, const Type* expected);

}  // namespace lineshaft::st

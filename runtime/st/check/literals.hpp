#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A literal as it is written: notes its value. A number has no type of its own yet.
const Type* check_literal(Checking& c, Expression*& e);
/// `INT#5`, `Colour#red`.
const Type* check_typed(Checking& c, Expression*& e);
/// `DTL#2020-02-29-12:30:15` as its parts.
Expression* list_of_dtl(Checking& c, const Expression& literal, const Type& type);

}  // namespace lineshaft::st

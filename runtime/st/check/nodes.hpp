#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Its value is known, and its type.
bool is_constant(const Expression& expression);
/// Of a constant that is a number.
double as_real(const Expression& constant);
/// A node where `like` stands.
Expression* make(Checking& c, E kind, const Expression& like);

void become(Expression& e, const Type& type, Constant value);
void become_boolean(Expression& e, bool value);
/// Of a function of the standard's own sources.
Expression* make_call(Checking& c, std::string_view function, Expression* argument);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// In the routine, then in its block, then among the globals; null if there is none.
Variable* find_variable(Checking& c, const Token& token);
/// Adds it, or tells that it is declared twice.
bool is_new_name(Checking& c, Token name, NameMap<Place>& names, bool is_test = false);

/// What a suggestion is chosen from.
std::vector<std::string> visible_names(Checking& c);
/// Told once in a block, unless it may be declared in what was not understood.
const Type* undeclared(Checking& c, const Token& name, Place place,
                       const std::vector<std::string>& names);

/// `e` means the variable; one that is constant is its value.
const Type* use(Checking& c, Expression*& e, Variable& variable);
/// The enumeration of `Colour.red`; null if this is none.
const Type* enumeration_of(Checking& c, const Expression& member);

/// The value of that name.
const Type* check_value(Checking& c, Expression*& e, const Type& enumeration, const Token& name);

/// A variable, a value of an enumeration, TRUE, ENO, a block of the program where a reference is
/// `expected`. L0904 for what is not declared.
const Type* check_name(Checking& c, Expression*& e, const Type* expected);

}  // namespace lineshaft::st

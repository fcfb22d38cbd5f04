#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// `motor.speed`; also `Colour.red`, and a part of a block that is a function.
const Type* check_member(Checking& c, Expression*& e);
/// `table[i, 2]`, `text[3]`.
const Type* check_index(Checking& c, Expression& e);
/// `word.%X3`, `word.%B1`, `word.3`.
const Type* check_bit(Checking& c, Expression*& e);
/// Tells what may not be written; `how` it would be.
bool check_target(Checking& c, Expression& target, std::string_view how = "assigned");

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// What a structure, an instance of the catalogue or a block of the sources has by that name; null
/// if there is nothing.
Variable* find_member(const Type& type, std::string_view name);

/// What a suggestion is chosen from.
std::vector<std::string> names_of(const std::vector<Variable*>& variables);

/// `motor.speed`, whose variable is noted; also `Colour.red`, and a part of a block that is a
/// function. L0904 where there is none.
const Type* check_member(Checking& c, Expression*& e);
/// `table[i, 2]`, `text[3]`.
const Type* check_index(Checking& c, Expression*& e);
/// `word.%X3`, `word.%B1`, `word.3`.
const Type* check_bit(Checking& c, Expression*& e);
/// False for what may not be written, which was told, L0910; `how` it would be.
bool check_target(Checking& c, Expression& target, std::string_view how = "assigned");

}  // namespace lineshaft::st

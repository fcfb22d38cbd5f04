#pragma once

#include "runtime/st/check/checking.hpp"
#include "runtime/st/syntax/tree.hpp"
#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// `b := MOVE(1);`: 0 and 1 are values of BOOL as well.
bool are_bits(const Expression& call, std::size_t first);

/// What a literal as `0.1` among the arguments is beside an integer.
const Type& real_of_literals(const Expression& call, std::size_t first, const Type* expected);

/// What whole numbers without a type become where `expected` is due: they stay whole where a real
/// number holds them all, so that `SEL(b, 1, 3) / 2` is 1.
const Type& type_of_literals(const Expression& call, std::size_t first, const Type& expected);

/// What holds the literals from `first` on beside `common`, what the others have in common: a
/// literal is as large as it is, and so is what is made of it. `common` where that holds all, and
/// where what is due takes no more, outside of CODESYS.
const Type& type_with_literals(const Expression& call, std::size_t first, const Type& common,
                               const Type* expected);
/// What was chosen in `type` only because of a literal becomes what is due again, with a warning.
const Type* take_back(Checking& c, Expression*& e, const Type* type, const Type* expected);

}  // namespace lineshaft::st

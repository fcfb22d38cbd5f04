#pragma once

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

}  // namespace lineshaft::st

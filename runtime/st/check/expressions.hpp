#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// The type of `e`, noted in it; null if it has none, which was told then. `expected` is what it
/// goes to, if that is known: it gives numbers, names of enumerations and functions their type, and
/// does not convert. What `e` stands for is hung in its place: a constant for what is folded.
const Type* check(Checking& c, Expression*& e, const Type* expected = nullptr);

}  // namespace lineshaft::st

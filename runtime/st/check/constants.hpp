#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// An operator with a constant, whose type is noted, becomes its result.
void fold_unary(Checking& c, Expression*& e);
/// The same of two constants of one type. L0908 where it divides by zero, or leaves 64 bits.
void fold(Checking& c, Expression*& e);
/// What is made of constants, operators, conversions and functions of the standard becomes its
/// value, with the bits of a scan: the machine reckons. True if it is a constant then. L0908 where
/// that ends with a fault.
bool evaluate(Checking& c, Expression*& e);

/// Checks `e` and reckons it: a whole number that is known when compiling, of `type`. Empty if it
/// is none, which was told, L0913.
std::optional<Wide> check_whole(Checking& c, Expression*& e, const Type& type);

}  // namespace lineshaft::st

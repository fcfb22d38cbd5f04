#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// CODESYS and TwinCAT call functions of an application by themselves, where it has them. They are
/// not called in one another, in what a library has, nor for constants.

/// `list[CheckBounds(i, lower, upper)]`, of each dimension.
void guard_index(Checking& c, Expression*& index, const Type& array);
/// `a / CheckDivDInt(b)`, CheckDivLInt, CheckDivReal and CheckDivLReal, which go by the type that
/// is divided in; one with that type's own name, CheckDivInt, comes before.
void guard_divisor(Checking& c, Expression*& divisor);
/// `part := CheckRangeSigned(x, lower, upper)` of a subrange, CheckRangeUnsigned, and of 64 bits
/// CheckLRangeSigned and CheckLRangeUnsigned.
void guard_range(Checking& c, Expression*& value, const Type& subrange);

}  // namespace lineshaft::st

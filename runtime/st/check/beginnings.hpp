#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// What a variable of a block or a call begins with, where that is no constant: `p : POINTER TO INT
/// := ADR(x);`. It is assigned when the block or one of its methods runs first, of a call in each.
/// False: the variable begins with constants only.
bool begin_with(Checking& c, Expression*& value, const Type& type);

/// An instance of this type has an FB_init.
bool is_constructed(const Type* type);

/// Calls FB_init of the instance that the variable is, with what stands behind its type, at the
/// same time. What is declared behind that, `:= (x := 1)`, is assigned behind it.
void begin_instance(Checking& c, Variable& variable);

/// These assignments and calls: of a base first, and of its FB_init in one that stands for it.
Block beginnings(Checking& c, Routine& routine);

}  // namespace lineshaft::st

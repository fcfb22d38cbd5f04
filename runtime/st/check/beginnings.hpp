#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// What a variable begins with, where that is no constant: `p : POINTER TO INT := ADR(x);`. It is
/// assigned when the block or one of its methods runs first, of a call in each.
/// False: the variable begins with constants only.
bool begin_with(Checking& c, Expression*& value, const Type& type);

/// Calls FB_init of the instances that the variable is or has in it, with what stands behind its
/// type, at the same time.
void begin_instance(Checking& c, Variable& variable);

/// What VAR_GLOBAL begins with so comes before the first block that runs, one that no other has an
/// instance of.
void begin_globals(Checking& c);

/// These assignments and calls: of a base first, and of its FB_init in one that stands for it.
Block beginnings(Checking& c, Routine& routine);

}  // namespace lineshaft::st

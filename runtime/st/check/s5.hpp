#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// `T1`, `C2`, which nobody declares: a timer or a counter of a Siemens controller itself. Empty:
/// the name is none. Its number where that is due, else its signal.
std::optional<const Type*> check_s5_name(Checking& c, Expression*& e, const Type* expected);

/// The signal of a TIMER or a COUNTER, `type`, is meant where no number is due.
const Type* signal_of_s5(Checking& c, Expression*& e, const Type& type, const Type* expected);

/// `T1 := FALSE;`, as a coil of LAD resets it; false where it is no such.
bool rewrite_s5_reset(Checking& c, Statement*& s);

/// `"Delay" AT %T1 : TIMER` is the number 1. False: `at` is no place of one, and this was told.
bool locate_s5(Checking& c, Variable& variable, const Token& at);

/// An S5TIME and a TIME become one another; false where nothing was done.
bool coerce_s5time(Checking& c, Expression*& e, const Type& to);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/check.hpp"

namespace lineshaft::st {

/// For check(): assigns the expression to a variable in a program of its own, and runs that.
Evaluated evaluate(Expression& expression);

}  // namespace lineshaft::st

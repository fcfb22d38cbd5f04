#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Names of all types and routines; then the types.
void collect_names(Checking& c);

/// A variable in `to`, with its unit, which is checked.
Variable* add(Checking& c, std::deque<Variable>& to, const Declaration& declared, const Type* type);
/// One that a type or another constant asks for, wherever it is declared; null when it asks for
/// itself, or over too many others.
Variable* declare_early(Checking& c, const Checking::GlobalConstant& constant);

/// The variable stands beside all blocks, where no source names it: VAR_STAT, and what the checker
/// adds.
void keep_once(Checking& c, Variable& variable);

/// VAR_GLOBAL and data blocks.
void declare_globals(Checking& c);
/// Variables, results and constants of all routines, and which they are made of.
void declare_routines(Checking& c);

}  // namespace lineshaft::st

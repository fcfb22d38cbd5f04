#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Names of all types and routines; then the types.
void collect_names(Checking& c);

/// A variable in `to`.
Variable* add(Checking& c, std::deque<Variable>& to, const Declaration& declared, const Type* type);
/// One that a type or another constant asks for, wherever it is declared; null when there is none,
/// or it asks for itself, or over too many others.
Variable* declare_early(Checking& c, std::string_view name);

void declare_globals(Checking& c);
void declare_routines(Checking& c);

}  // namespace lineshaft::st

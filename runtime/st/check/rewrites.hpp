#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A statement that means others is checked as those.
bool rewrite(Checking& c, Statement*& s);

/// Siemens' ENO, a flag of each call that begins as TRUE: a caller may take it.
Variable& eno_of(Checking& c, Routine& routine);

/// `go.R_EDGE(CLK := go);`, in front of the body.
void call_edges(Checking& c, Routine& routine);

/// `go` in a body is `go.R_EDGE.Q`.
const Type* use_edge(Checking& c, Expression*& e, Variable& input);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A statement that means others, `y := f(EN := go)` or SCATTER, is checked as those, which are
/// hung in its place. False if it means itself, and is not checked.
bool rewrite(Checking& c, Statement*& s);

/// Siemens' ENO, a flag of each call that begins as TRUE: a caller may take it.
Variable& eno_of(Checking& c, Routine& routine);

/// What runs in front of its body: `go.R_EDGE(CLK := go);`.
Block edge_calls(Checking& c, Routine& routine);

/// `go` in a body is `go.R_EDGE.Q`.
const Type* use_edge(Checking& c, Expression*& e, Variable& input);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// The routine's body, and what runs in front of it.
void check_body(Checking& c, Routine& routine);
/// A statement with all that is in it. What it stands for is hung in its place.
void check(Checking& c, Statement*& s);
/// `target := value;`; `+=` is one of a sum. L0910 for what may not be assigned.
void check_assignment(Checking& c, Statement*& s);

}  // namespace lineshaft::st

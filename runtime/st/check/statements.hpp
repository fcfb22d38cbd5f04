#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

void check_body(Checking& c, Routine& routine);
void check(Checking& c, Statement*& s);
void check_assignment(Checking& c, Statement*& s);

}  // namespace lineshaft::st

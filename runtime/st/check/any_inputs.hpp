#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Of an input that is ANY, as CODESYS and TwinCAT have it.
bool is_any_input(const Type& type);

/// `value`, a variable of any type, becomes what such an input has inside: its class, where it is,
/// how many bytes it has. What came by such an input is passed on.
void become_any(Checking& c, Expression*& value, const Type& type);

}  // namespace lineshaft::st

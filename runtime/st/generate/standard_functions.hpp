#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// Of a text, an array or a structure, a slot with its address.
Slot standard(Writing& w, const Expression& e, Slot wanted);

}  // namespace lineshaft::st

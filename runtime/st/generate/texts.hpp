#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// A slot with the address of the value, which is a text.
Slot text_address(Writing& w, const Expression& e);

}  // namespace lineshaft::st

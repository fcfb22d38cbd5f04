#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

void write_block(Writing& w, const Block& block);

}  // namespace lineshaft::st

#pragma once

/// The codes of messages by name: code::unknown_key is `L0201`. Code, name and what
/// `lineshaft explain` prints stand in codes.txt, of which the build makes this list.

namespace lineshaft::code {

#include "runtime/source/code_names.inc"
#include "runtime/source/codes.hpp"

}  // namespace lineshaft::code

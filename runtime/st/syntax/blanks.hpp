#pragma once

#include "runtime/st/syntax/characters.hpp"

namespace lineshaft::st {

/// Goes on to the next token. Comments and pragmas are noted; what an `{IF}` leaves out is passed
/// by.
void skip_blanks(Characters& in);

}  // namespace lineshaft::st

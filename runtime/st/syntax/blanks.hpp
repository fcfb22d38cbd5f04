#pragma once

#include "runtime/st/syntax/text_cursor.hpp"

namespace lineshaft::st {

/// Goes on to the next token. Comments and pragmas are noted; what an `{IF}` leaves out is passed
/// by.
void skip_blanks(TextCursor& in);

}  // namespace lineshaft::st

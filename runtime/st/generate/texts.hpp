#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// A slot with the address of the value, which is a text.
Slot text_address(Writing& w, const Expression& e);

/// An empty text among the temporaries, and a slot with its address.
struct NewText {
    Slot text, address;
};
NewText new_text(Writing& w);

}  // namespace lineshaft::st

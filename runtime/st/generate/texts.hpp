#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// A slot with the address of the value, which is a text.
Slot text_address(Writing& w, const Expression& e);

/// That of a copy, where `e` is a variable and `later` calls what may write it.
Slot text_before(Writing& w, const Expression& e, const Expression& later);

/// An empty text among the temporaries, and a slot with its address.
struct NewText {
    Slot text, address;
};
NewText new_text(Writing& w);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/library/kind.hpp"

namespace lineshaft::st {

/// The kind of block that has a program's process image: its bytes, and of each address that is
/// named a value as others see it, which is a field `%QW4`. Before all blocks of its task it takes
/// what has changed of these values since (wires, stimuli, forces, clients) into the bytes, and
/// after them it shows what the bytes have. Of an address in I the field is an input, in Q an
/// output, in M a local,
/// and an input of the same name, which others set.
BlockType image_type(Library::Made& made, const std::shared_ptr<const Library::Made>& owner,
                     const Global& global);

}  // namespace lineshaft::st

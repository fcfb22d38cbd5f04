#pragma once

#include <span>
#include <string>
#include <string_view>

#include "runtime/st/code/code.hpp"

namespace lineshaft::st {

/// The code of a library as a source in C++, which needs no other file: each instruction is its
/// line in `opcodes.hpp`, with its operands as literals, each routine a function. What the lines
/// call outside are the `externals`, whose addresses `native_begin` takes in their order; it gives
/// the scans of the routines. The same code makes the same text.
std::string emitted(const Code& code, std::span<const std::string_view> externals);

/// What `emitted` of this program looks at, as bytes: where they are the same, the text is.
std::string emission_key(const Code& code);

}  // namespace lineshaft::st

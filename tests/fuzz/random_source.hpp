#pragma once

#include <string>
#include <string_view>

#include "tests/fuzz/choices.hpp"

namespace lineshaft::test {

/// A `PROGRAM Main` in Structured Text with the types, data blocks, functions and function blocks
/// that it uses, over all elementary and derived types. It compiles without an error; every loop
/// ends after a few passes. A scan may end with a fault (a division, an index, a conversion), once
/// in a while. The first decision is always the simplest: with no bytes the program does nothing.
std::string random_source(Choices& choices);

/// An expression of an elementary type, of literals with their types only: `INT#5 + ABS(INT#-3)`.
std::string random_constant(Choices& choices, std::string_view type);

}  // namespace lineshaft::test

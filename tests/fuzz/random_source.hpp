#pragma once

#include <string>
#include <string_view>

#include "tests/fuzz/choices.hpp"

namespace lineshaft::test {

/// Where the pointers of a program lead.
enum class Pointers {
    tame,  ///< along what they are in, and seldom out of it
    wild,  ///< anywhere, to what calls had too
};

/// A `PROGRAM Main` in Structured Text with the types, data blocks, functions, function blocks and
/// interfaces that it uses, over all elementary and derived types. It compiles without an error;
/// every loop ends after a few passes. A scan may end with a fault (a division, an index, a
/// conversion, a method that runs already), once in a while; of wild pointers mostly. The first
/// decision is always the simplest: with no bytes the program does nothing.
std::string random_source(Choices& choices, Pointers pointers = Pointers::tame);

/// An expression of an elementary type, of literals with their types only: `INT#5 + ABS(INT#-3)`.
std::string random_constant(Choices& choices, std::string_view type);

}  // namespace lineshaft::test

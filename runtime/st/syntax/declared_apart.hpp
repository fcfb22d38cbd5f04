#pragma once

#include "runtime/st/syntax/tree.hpp"

namespace lineshaft::st {

/// B&R declares the functions and blocks of a library in a file of its own, `.fun`, and writes
/// their bodies elsewhere, without variables: both are one unit. A declaration that has no body
/// anywhere stays as it is.
void join_declared_apart(Tree& tree);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

void fold_unary(Checking& c, Expression*& e);
/// An operator with constants becomes its result.
void fold(Checking& c, Expression*& e);
/// The machine does it, in a program of its own, so that the bits are those of a scan.
bool evaluate(Checking& c, Expression*& e);

/// A whole number that is known when compiling, in `type`; empty if it is none, which was told.
std::optional<Wide> check_whole(Checking& c, Expression*& e, const Type& type);

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

constexpr Wide most_elements = 1 << 24;  ///< of an array

/// Null where a type is wrong, which was told.
const Type* resolve(Checking& c, const TypeText& text);
const Type* resolve_name(Checking& c, const Token& name);
const Type* resolve_declared(Checking& c, NamedType& named);

}  // namespace lineshaft::st

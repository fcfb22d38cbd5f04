#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// `view AT other : T` of a routine, whose variables are declared: what each is a view of.
void declare_overlays(Checking& c, Routine& routine);

/// Where no variable has another's bytes: in a structure, among globals.
void refuse_overlay(Checking& c, const Declaration& declared);

/// `e`, which means an overlay, becomes what is seen of the other variable.
const Type* use_overlay(Checking& c, Expression*& e, const Variable& overlay);

}  // namespace lineshaft::st

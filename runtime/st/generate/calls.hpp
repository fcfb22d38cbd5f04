#pragma once

#include "runtime/st/generate/places.hpp"

namespace lineshaft::st {

/// Of a function, a method or a standard function.
Slot call(Writing& w, const Expression& e, Slot wanted);

/// The frame that has the result and the outputs. A call whose arguments call functions themselves
/// has them first, for they use the same memory; where the places of outputs do, what the function
/// has made is kept from them.
Location call_routine(Writing& w, const Expression& e);
void call_instance(Writing& w, const Expression& e);

}  // namespace lineshaft::st

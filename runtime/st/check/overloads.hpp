#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Which of the functions or methods that share the name of `first` a call means: the one whose
/// arguments are of the types that are given, or need the least conversion. Where none fits it is
/// the first, whose call is refused then.
Routine& overload_of(Checking& c, Expression& call, const NameMap<std::vector<Routine*>>& overloads,
                     Routine& first);

}  // namespace lineshaft::st

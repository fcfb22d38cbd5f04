#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// Tells when there are too few arguments, or too many.
bool check_count(Checking& c, const Expression& call, const StandardFunction& f);
/// Arguments by name may stand in any order: those of the call that stands for it are in that of
/// the function. False for a name that is none, which was told.
bool order_arguments(Checking& c, Expression*& e, const StandardFunction& f);

/// A function of the standard, or a conversion by its name: `expected` as in check().
const Type* check_standard_function(Checking& c, Expression*& e, const Type* expected);

}  // namespace lineshaft::st

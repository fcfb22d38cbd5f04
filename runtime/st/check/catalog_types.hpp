#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A block of the catalogue, or a reference to one, also by the name that vendors give it; null for
/// another name.
const Type* standard_type(Checking& c, std::string_view name);

}  // namespace lineshaft::st

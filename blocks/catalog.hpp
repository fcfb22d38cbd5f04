#pragma once

#include "runtime/model/catalog.hpp"

namespace lineshaft {

/// Every block a program may use.
Catalog standard_blocks();

}  // namespace lineshaft

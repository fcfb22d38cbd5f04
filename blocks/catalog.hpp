#pragma once

#include "runtime/model/catalog.hpp"

namespace lineshaft {

/// Every block a program may use.
const Catalog& standard_blocks();

}  // namespace lineshaft

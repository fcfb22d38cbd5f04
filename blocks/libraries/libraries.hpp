#pragma once

#include <span>

#include "runtime/model/catalog.hpp"

namespace lineshaft {

/// The files below this folder, by their paths.
std::span<const LibraryFile> vendor_libraries();

}  // namespace lineshaft

#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "blocks/path/path.hpp"

namespace lineshaft::test {

/// Along the path these, of each axis none.
PathLimits wide_limits(const PathLimit& path);

/// The limit that a motion is above, or empty.
std::string violation(const PathMotion& m, const PathLimits& limits);

/// What is planned is in motion at a joint on its way that is a stop, by more than rounds there.
bool passes_stop(const Path& path, std::span<const PathPiece> ring, const PathLimits& limits);

}  // namespace lineshaft::test

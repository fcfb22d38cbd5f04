#pragma once

#include <cstdint>
#include <span>

#include "blocks/path/path_stretch.hpp"

namespace lineshaft {

/// Pieces of a path from `first` on, up to `count`, in their ring.
struct PathPieces {
    std::span<const PathPiece> ring;
    std::uint64_t first = 0, count = 0;

    const PathPiece& operator[](std::uint64_t number) const { return ring[number % ring.size()]; }
};

}  // namespace lineshaft

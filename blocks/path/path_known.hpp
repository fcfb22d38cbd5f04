#pragma once

#include <cstdint>
#include <span>

#include "blocks/path/path.hpp"

namespace lineshaft {

/// The stretches that are planned with, from the one under way on.
ConstPathStretches stretches_of(const Path& path, std::span<const PathPiece> ring);

/// A stretch is another, or behind it there is more.
void note_change(Path& path, std::uint64_t stretch);

/// What the leg under way comes to the stretch behind it with.
PathReliance reliance_of(const Path& path);

/// The first `count` stretches are planned with, as if the path ended with them.
void look_back_from(Path& path, std::span<PathPiece> ring, std::uint64_t count,
                    const PathReliance& relied);

/// As many stretches are planned with as count from where the path is (README.md, "Appending").
void look_back_as_needed(Path& path, std::span<PathPiece> ring, const PathReliance& relied);

/// It is the same, however the path goes on.
bool is_sure(const Path& path, const PathLeg& leg);

}  // namespace lineshaft

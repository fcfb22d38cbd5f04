#include "blocks/path/path_known.hpp"

#include <algorithm>

#include "blocks/path/path_ahead.hpp"

namespace lineshaft {

namespace {

/// What is looked at from the stretch under way on is the same, however the path goes on.
bool is_far_ahead(const Path& path) {
    return path.sure >= path.stretch + most_pieces_ahead;
}

}  // namespace

ConstPathStretches stretches_of(const Path& path, std::span<const PathPiece> ring) {
    return {ring, path.stretch, path.known};
}

void note_change(Path& path, std::uint64_t stretch) {
    path.changed = std::min(path.changed, stretch);
    path.fresh = true;
}

PathReliance reliance_of(const Path& path) {
    return {path.leg.goal + 1, path.leg.end_velocity()};
}

void look_back_from(Path& path, std::span<PathPiece> ring, std::uint64_t count,
                    const PathReliance& relied) {
    if (count != path.known) {
        const std::uint64_t both = std::min(count, path.known);
        path.changed = std::min(path.changed, both > 0 ? both - 1 : 0);
        path.known = count;
    }
    if (path.changed >= count) return;
    const PathStretches stretches{ring, path.stretch, count};
    look_back(stretches, path.changed, relied);
    path.changed = count;
    path.sure = count;
    while (path.sure > path.stretch && !stretches.is_bound_by_joint(path.sure - 1)) --path.sure;
}

void look_back_as_needed(Path& path, std::span<PathPiece> ring, const PathReliance& relied) {
    if (!path.stale && is_far_ahead(path)) return look_back_from(path, ring, path.known, relied);
    if (!path.stale && path.stretches > path.stretch + most_pieces_ahead)
        look_back_from(path, ring, path.stretches - 1, relied);
    if (path.stale || !is_far_ahead(path)) look_back_from(path, ring, path.stretches, relied);
}

bool is_sure(const Path& path, const PathLeg& leg) {
    return leg.goal + 1 < path.sure;
}

}  // namespace lineshaft

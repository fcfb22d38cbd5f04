#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "blocks/path/path_course.hpp"
#include "blocks/path/path_pieces.hpp"
#include "blocks/path/path_speed.hpp"

namespace lineshaft {

/// The intervals over which a course is looked for: short where the guess is slow, and where a
/// curve turns.
struct PathMesh {
    std::size_t count = 0;
    std::array<SpeedInterval, most_speed_intervals> intervals;
    std::array<double, most_speed_intervals> energies{};  ///< w of the guess in their middles

    std::span<const SpeedInterval> span() const { return {intervals.data(), count}; }
};

/// Into how many intervals a piece is divided at least, and how many rows each has about.
struct MeshNeed {
    double intervals = 0, rows = 0;
};
MeshNeed mesh_need(const PathPiece& piece);

/// What a mesh of a course is to be like.
struct MeshWish {
    double begin = 0, end = 0;          ///< within the course [u]
    double base = 0;                    ///< where the course begins along the path [u]
    double factor = 1;                  ///< of the velocities
    double from_rest = 0, to_rest = 0;  ///< > 0: for so long [s] it comes from standstill before
                                        ///< `begin`, or goes to it behind `end`
};

/// False where there would be too many intervals, or one without length.
bool make_mesh(const PathPieces& pieces, const PathCourse& guess, const MeshWish& wish,
               PathMesh& out);

}  // namespace lineshaft

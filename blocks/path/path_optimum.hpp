#pragma once

#include "blocks/path/path_course.hpp"
#include "blocks/path/path_pieces.hpp"

namespace lineshaft {

/// From the same state to the same end as `guess`, in about the least time and within all limits,
/// with `factor` of the velocities; `base` is where along the path both begin. Where the guess is
/// next to it it may be no sooner. False, and `out` is of no use, where none is found.
bool find_optimum(const PathPieces& pieces, const PathCourse& guess, double base, double factor,
                  PathCourse& out);

}  // namespace lineshaft

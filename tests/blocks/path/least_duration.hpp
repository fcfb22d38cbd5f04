#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blocks/path/path_pieces.hpp"

namespace lineshaft {

/// Pieces that are run along from standstill to standstill without a stop between.
struct WholeWay {
    std::vector<const PathPiece*> pieces;

    double length() const;
};

/// The ways between the stops of a path that has not begun yet.
std::vector<WholeWay> ways_between_stops(std::span<const PathPiece> ring, std::uint64_t pieces,
                                         std::uint64_t stretches);

/// No motion within the velocities and accelerations of path and axes is sooner, whatever its jerk:
/// by the greatest speed at each of many places from which the rest can be braked on [s].
double least_without_jerk(const WholeWay& way, int places_per_piece);

/// A dynamic programme over the way (Bellman): v^2/2 and the acceleration at places `step` apart
/// are multiples of `acceleration` step / 2 and `acceleration`. Between places the acceleration
/// changes evenly with the way, so that each motion leads from one point of that lattice exactly to
/// another, and nothing is interpolated; from and to standstill two jerks lead. All limits hold at
/// both ends of each step. With a finer lattice the duration falls to the least one with jerk. All
/// pieces are a whole number of steps long. Infinite where the lattice is too coarse for any motion
/// [s].
double least_of_lattice(const WholeWay& way, double step, double acceleration);

}  // namespace lineshaft

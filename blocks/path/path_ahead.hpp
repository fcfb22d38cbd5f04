#pragma once

#include <cstdint>

#include "blocks/path/path_leg.hpp"
#include "blocks/path/path_pieces.hpp"

namespace lineshaft {

/// What a leg is looked for from: stretches and pieces from those under way on.
struct PathOutlook {
    ConstPathStretches stretches;
    PathPieces pieces;
    double factor = 1;  ///< of the velocities
    PathLimit halt;     ///< acceleration and jerk of a halt; none: those of the pieces
};

/// A course is looked for over fewer pieces.
inline constexpr std::uint64_t most_pieces_ahead = 56;

/// Makes of a leg and those that would follow it one that is sooner, where curves leave more than
/// boxes; `since` is how much of the leg is over [s]. False, and the leg is as it was, where there
/// is none. What is looked for in vain is not looked for again from leg to leg.
bool look_ahead(const PathOutlook& outlook, double since, PathLeg& leg, PathVain& vain);

/// What can be had from a state that is in no box, as an optimum may lead through: the sooner ones
/// are to be tried for again from a later state.
enum class IntoBoxes : std::int64_t { none, late, soon };

/// A ramp within all limits to a velocity from which a leg goes on, or to standstill; at once to
/// that where `factor` is 0. `out` is unchanged where there is none.
IntoBoxes plan_into_boxes(const PathOutlook& outlook, const MotionState& from, double base,
                          PathLeg& out);

/// A halt that needs no box: with acceleration and jerk of `halt`, or else of the pieces, along the
/// path, and within the limits of the axes. `out` is unchanged where there is none that is over
/// sooner than `within` [s].
IntoBoxes plan_harder_halt(const PathOutlook& outlook, const MotionState& from, double base,
                           double within, PathLeg& out);

}  // namespace lineshaft

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "blocks/path/path_bound.hpp"
#include "blocks/path/path_box.hpp"
#include "blocks/path/path_phase.hpp"

namespace lineshaft {

/// Consecutive pieces with one box and smooth joints; what is planned for it once. `entry` is the
/// greatest velocity at its start, with acceleration 0, from which the rest of the path can be
/// braked on: one ramp from there to the end of `target`, in the least of the boxes on its way, and
/// so on from there. Lengths are along the path, from its start.
struct PathStretch {
    PathLimit box;
    double begin = 0, end = 0;  ///< [u]
    double joint = 0;           ///< greatest velocity at its end by the joint itself; 0: a stop
    double entry = 0;           ///< [u/s]
    std::uint64_t target = 0;   ///< number of a stretch
    double ramp_end = 0;        ///< where in it, and ...
    double ramp_exit = 0;       ///< ... at which velocity that ramp ends; its exit is no less
    PathLimit span;             ///< the least of the boxes from here to `target`
    double settled = 0;  ///< from here on the ramp is that of any greater velocity before [u]
};

/// One place of the ring: piece n, and stretch m, of the numbers n and m that lie there. There are
/// no more stretches than pieces.
struct PathPiece {
    PathCurve curve;
    PathLimits limits;  ///< of a corner the lesser ones of both its neighbours
    std::array<PathBound, most_path_axes> bounds{};  ///< of the curve
    double begin = 0;                                ///< along the path [u]
    double way = 0;  ///< of the first three axes, from the start of the path to where it begins [u]
    PathStretch stretch;

    double end() const { return begin + curve.length; }
};

/// The stretches in a ring from `first` on, up to `count`.
template <class Piece>
struct PathStretchesOf {
    std::span<Piece> ring;
    std::uint64_t first = 0, count = 0;

    auto& operator[](std::uint64_t number) const { return ring[number % ring.size()].stretch; }
    bool is_last(std::uint64_t number) const { return number + 1 == count; }

    /// Greatest velocity at the end of a stretch from which the rest can be braked on [u/s].
    double exit(std::uint64_t number) const {
        return is_last(number) ? 0 : std::min((*this)[number].joint, (*this)[number + 1].entry);
    }

    /// The joint itself bounds `exit`, or the factor that velocities have, and not what is behind.
    bool is_bound_by_joint(std::uint64_t number, double factor = 1) const {
        constexpr double rounding = 1e-8;
        return !is_last(number) &&
               (*this)[number + 1].entry >= factor * (*this)[number].joint * (1 - rounding);
    }

    /// A joint before a stretch has to be stood at.
    bool passes_stop(std::uint64_t number) const {
        for (std::uint64_t k = first; k < number; ++k)
            if ((*this)[k].joint == 0) return true;
        return false;
    }
};

using PathStretches = PathStretchesOf<PathPiece>;
using ConstPathStretches = PathStretchesOf<const PathPiece>;

/// What the leg under way comes to a stretch with: from there on it is to be braked, whatever else
/// is found.
struct PathReliance {
    std::uint64_t stretch = 0;
    double velocity = 0;  ///< [u/s]
};

/// Finds `entry` of all stretches anew whose end, box or joint has changed, which are those from
/// `changed` on, and of those before as far as that goes. What was there has only grown, or is not
/// relied on: where less is found than what the leg under way needs, the ramp that it needs stays.
void look_back(PathStretches stretches, std::uint64_t changed, const PathReliance& relied);

}  // namespace lineshaft

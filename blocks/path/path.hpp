#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "blocks/path/path_curve.hpp"
#include "blocks/profile/any_state.hpp"

namespace lineshaft {

struct PathLimit {
    double velocity = 1, acceleration = 1, jerk = 1;  ///< all > 0 [u/s^n]
};

/// Limits of the motion along the path and of each axis; they hold together at any instant.
struct PathLimits {
    PathLimit path;
    std::array<PathLimit, most_path_axes> axes;
};

/// How the joint before a piece is passed.
struct PathJoint {
    double velocity = std::numeric_limits<double>::infinity();  ///< at most; 0: a stop [u/s]
    double distance = 0;  ///< > 0: two lines are joined by a corner this far from the vertex [u]
};

/// One piece in the ring, with what is planned for it once: within it s', s'' and s''' keep to
/// `cap`, and then all limits are kept (README.md). At a joint the acceleration along the path is
/// 0.
struct PathPiece {
    PathCurve curve;
    PathLimit cap;
    double joint = 0;  ///< greatest velocity at its end by the joint itself: 0 is a stop there
    double exit = 0;   ///< ... and from which the rest of the path can be braked on [u/s]
};

/// The motion along the path at one instant, and that of the axes.
struct PathMotion {
    MotionState path;  ///< over the length from the start of the first piece
    PathVector position{}, velocity{}, acceleration{}, jerk{};
};

/// A path of pieces that is run along with constant jerk from phase to phase. The pieces lie in a
/// ring that the caller owns and gives with each call, the same one each time: this and the ring
/// are plain bytes without an address, and nothing is allocated. Pieces are appended at any time,
/// also in motion. What is commanded counts from the next `advance`.
///
/// At any instant, whatever is commanded: the velocity along the path is not negative, limits of
/// path and axes are kept, positions lie on the curves, and the last piece ends exactly at its end
/// with velocity 0. Override changes the velocity only, not acceleration and jerk.
struct Path {
    std::uint64_t first = 0;  ///< number of the piece under way, counted from 0
    std::uint64_t count = 0;  ///< pieces appended so far
    double total = 0;         ///< length of all pieces appended [u]
    double travelled = 0;     ///< length of the pieces before the one under way [u]
    double time = 0;          ///< since the plan began [s]
    double override = 1;      ///< factor of the velocity, >= 0
    bool halted = false;
    bool stale = false;       ///< what was planned is to be planned anew
    bool lost = false;        ///< numbers too many decades apart to be planned: it stands there
    MotionPlan plan;          ///< along the piece under way, from its start on
    std::uint64_t phase = 0;  ///< of the plan, where the last instant was found

    /// One piece more, with its limits. A corner is as far from the vertex as `joint` says, or as
    /// the lines leave room, half of the new one; where the path under way cannot be braked any
    /// more before it begins, or there is no room in the ring, the vertex is a stop.
    /// `joint.velocity` does not count where there is a corner.
    PathFault append(std::span<PathPiece> ring, const PathCurve& curve, const PathLimits& limits,
                     const PathJoint& joint = {});

    /// `factor` >= 0; 0 is a halt that ends with another factor.
    void set_override(double factor);

    /// Brakes to standstill on the path as soon as the limits of the pieces allow; the rest of the
    /// path stays, and `resume` goes on. MC_GroupInterrupt and MC_GroupContinue. A stop is a halt
    /// with `clear` at standstill.
    void halt();
    void resume();

    /// Forgets all pieces. Only at standstill.
    void clear();

    /// The motion dt >= 0 [s] later.
    PathMotion advance(std::span<PathPiece> ring, double dt);

    /// The motion now.
    PathMotion now(std::span<const PathPiece> ring) const;

    bool standing() const { return time >= plan.duration && plan.end.velocity == 0; }
    bool finished() const { return first == count; }

    /// What is left to its end [u].
    double remaining() const;
};

/// How far from the vertex a corner may begin that is passed with `velocity` [u/s].
double corner_distance_at(double velocity, const PathCurve& before, const PathCurve& after,
                          const PathLimits& limits);

}  // namespace lineshaft

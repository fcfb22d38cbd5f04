#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "blocks/path/path_leg.hpp"

namespace lineshaft {

/// How the joint before a piece is passed. Where `distance` > 0 two lines or arcs are joined by a
/// corner or a transition.
struct PathJoint {
    static constexpr double any = std::numeric_limits<double>::infinity();
    double velocity = any;  ///< at most; 0: a stop [u/s]
    double distance = 0;    ///< from the vertex, at most, of where the corner begins and ends [u]
    PathBlend blend = PathBlend::low;
    double deviation = any;  ///< at most, of the corner from the vertex and from both pieces [u]
};

/// The motion along the path at one instant, and that of the axes.
struct PathMotion {
    MotionState path;  ///< over the length from the start of the first piece
    MotionState way;   ///< of the first three axes since then
    PathVector position{}, velocity{}, acceleration{}, jerk{};
};

/// A path of pieces that is run along in phases, of constant jerk on lines. The pieces lie in a
/// ring that the caller owns and gives with each call, the same one each time: this and the ring
/// are plain bytes without an address, and nothing is allocated. Pieces are appended at any time,
/// also in motion. What is commanded counts from the next `advance`, and so do pieces appended,
/// as soon as the motion would brake without them.
///
/// At any instant, whatever is commanded: the velocity along the path is not negative, limits of
/// path and axes are kept, positions lie on the curves, and the last piece ends exactly at its end
/// with velocity 0. Override changes the velocity only, not acceleration and jerk.
///
/// Where nothing is commanded the motion is the same whatever the instants at which it is looked
/// at: it is planned anew at instants of its own. Who appends more than the ring holds does so
/// where pieces are left, and not later: see `advance_to`.
struct Path {
    static constexpr std::uint64_t to_end = std::numeric_limits<std::uint64_t>::max();
    static constexpr double any_time = std::numeric_limits<double>::infinity();

    std::uint64_t first = 0;      ///< number of the piece under way, counted from 0
    std::uint64_t count = 0;      ///< pieces appended so far
    std::uint64_t stretch = 0;    ///< number of the stretch under way, counted from 0
    std::uint64_t stretches = 0;  ///< of the pieces appended so far
    std::uint64_t known = 0;    ///< stretches that are planned with; the others come to count later
    std::uint64_t sure = 0;     ///< entries of those before this one stay, whatever is appended
    std::uint64_t changed = 0;  ///< the first stretch that has changed since the last look back
    double total = 0;           ///< length of all pieces appended [u]
    double time = 0;            ///< since the leg under way began [s]
    double again = any_time;    ///< then [s] it is tried to plan anew what could not be planned
    double override = 1;        ///< factor of the velocity, >= 0
    PathLimit braking = no_path_limit;  ///< of a halt
    bool halted = false;
    bool stale = false;  ///< what was commanded is to be planned with the next `advance`
    bool fresh = false;  ///< stretches have changed since the leg under way was planned
    bool lost = false;   ///< numbers too many decades apart to be planned: it stands there
    PathLeg leg;         ///< under way
    PathVain vain;

    /// One piece more, with its limits. A corner is as far from the vertex as `joint` says, or as
    /// the lines leave room, half of the new one; where the path under way cannot be braked any
    /// more before it begins, or there is no room in the ring, the vertex is a stop.
    /// `joint.velocity` does not count where there is a corner.
    PathFault append(std::span<PathPiece> ring, const PathCurve& curve, const PathLimits& limits,
                     const PathJoint& joint = {});

    /// `factor` >= 0; 0 is a halt that ends with another factor.
    void set_override(double factor);

    /// Brakes to standstill on the path as soon as the limits of the pieces allow, or with
    /// acceleration and jerk of `limit` instead of those along the path: gentler ones where there
    /// is room for that before the path ends. The rest of the path stays, and `resume` goes on,
    /// after standstill where a harder halt is under way. MC_GroupInterrupt and MC_GroupContinue. A
    /// stop is a halt with `clear` at standstill.
    void halt(const PathLimit& limit = no_path_limit);
    void resume();

    /// Forgets all pieces. Only at standstill.
    void clear();

    /// The motion dt >= 0 [s] later.
    PathMotion advance(std::span<PathPiece> ring, double dt);

    /// On by dt >= 0 [s], or less: to the instant at which `piece` is entered, or the path is over.
    /// How much [s].
    double advance_to(std::span<PathPiece> ring, double dt, std::uint64_t piece);

    /// The motion now.
    PathMotion now(std::span<const PathPiece> ring) const;

    bool standing() const { return time >= leg.duration() && leg.end_velocity() == 0; }
    bool finished() const { return first == count; }

    /// What is left to its end [u].
    double remaining() const;
};

}  // namespace lineshaft

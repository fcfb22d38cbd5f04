#pragma once

#include <array>
#include <cstdint>

#include "blocks/motion/cam_switches.hpp"

namespace lineshaft {

/// The way of an axis between two of its scans, a straight line over time.
struct Stretch {
    std::int64_t begin = 0, end = 0;  ///< [ns], begin < end
    double first = 0, last = 0;       ///< places, as SeenMotion has them
    double first_velocity = 0, last_velocity = 0;
    double further = 0;  ///< positions are places + further
    double period = 0;   ///< of a modulo axis, else 0

    /// On a modulo axis no more than its last turn, at the same speed.
    Stretch last_turn() const;
    /// A part from 0 to 1 of the way, as a time.
    std::int64_t time_at(double part) const;
};

/// A cam goes on or off.
struct SwitchChange {
    std::int64_t time = 0;  ///< [ns]
    bool on = false;
};

/// What a cam does in a stretch, in the order of time.
struct SwitchChanges {
    std::array<SwitchChange, 8> all;
    std::size_t count = 0;

    void add(std::int64_t time, bool on);
};

/// A cam as the axis moves past it.
///
/// Its edges move with the velocity, by the compensations; in between two scans they and the axis
/// go on straight lines. An edge that has switched holds until the axis has gone further from it
/// than the hysteresis; if the axis is then on its other side, the cam goes on or off there.
struct SwitchedCam {
    bool inside = false;  ///< a position cam: the axis is between its edges
    bool first_holds = false, last_holds = false;  ///< the edges
    bool on = false;
    bool forward = true;     ///< the axis has moved last
    std::int64_t until = 0;  ///< a time cam that is on goes off [ns]

    /// Where the axis is when nothing is known of its way.
    void begin(const SwitchCam& cam, const SwitchTrack& track, const Stretch& at_end);
    /// The stretch, and what comes by time up to `now`.
    void pass(const SwitchCam& cam, const SwitchTrack& track, const Stretch& way,
              SwitchChanges& changes);
    void expire(std::int64_t now, SwitchChanges& changes);

  private:
    struct Beyond;
    struct Edges;
    void pass_edges(const Edges& edges, const Stretch& way, bool counts, SwitchChanges& changes);
    void pass_trigger(const SwitchCam& cam, const SwitchTrack& track, const Edges& edges,
                      const Stretch& way, SwitchChanges& changes);
    void set(bool wanted, std::int64_t time, SwitchChanges& changes);
};

}  // namespace lineshaft

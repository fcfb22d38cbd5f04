#pragma once

#include <array>
#include <cstddef>

#include "blocks/path/path_phase.hpp"

namespace lineshaft {

/// A motion along a path in phases. Positions count from where it begins.
struct PathCourse {
    static constexpr std::size_t most_phases = 256;

    std::size_t count = 0;
    double duration = 0;  ///< [s]
    MotionState end;
    std::array<PathPhase, most_phases> phases{};

    /// Without any phase.
    void clear();

    /// One phase more, from `end` on or from where `start` says. False where there is no room.
    bool add(const PathPhase& phase, double lasts);

    double end_of(std::size_t phase) const {
        return phase + 1 < count ? phases[phase + 1].begin : duration;
    }

    /// State t seconds after the start; before it that at the start, behind it `end`.
    MotionState at(double t) const;

    /// When it is at a place, which counts from where it begins [s].
    double time_at(double place) const;
};

}  // namespace lineshaft

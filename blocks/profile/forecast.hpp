#pragma once

#include <array>
#include <cstddef>

#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

/// How a master is foreseen to move: pieces of constant jerk, one behind the other, the first from
/// 0 s on. The last one goes on for ever, with its velocity.
struct Forecast {
    struct Piece {
        double begin = 0;  ///< [s]
        MotionState start;
    };

    static constexpr std::size_t most_pieces = 80;

    std::array<Piece, most_pieces> pieces{};
    std::size_t count = 0;
    std::size_t known = 0;  ///< pieces that have passed already

    /// One piece more; where there is no room the one before goes on.
    void add(double begin, const MotionState& start);

    MotionState at(double t) const;

    /// When a piece ends [s]; infinite of the last one.
    double end(std::size_t piece) const;

    /// When it first will come to x, or be beyond it in the direction (its sign) [s]; infinite if
    /// never.
    double time_at(double x, double direction) const;

    /// Whether it moves against the direction before a time.
    bool goes_against(double direction, double before) const;

    /// The same, seen from `by` [s] before; it was at `before` then.
    Forecast after(double by, const MotionState& before) const;
};

}  // namespace lineshaft

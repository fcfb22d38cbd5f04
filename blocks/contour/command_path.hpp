#pragma once

#include <array>
#include <cstdint>

#include "blocks/circle/arc.hpp"

namespace lineshaft {

/// What is known of a point beside the commanded path; lengths in the unit of the points.
struct ContourEstimate {
    double signed_error = 0;       ///< contour error, above 0 on the left of the path
    Point normal;                  ///< unit vector to the left of the path; 0 where it has none
    std::int64_t points_back = 0;  ///< nearest command point: how many before the newest
    bool at_newest = false;        ///< nearest is the newest: its tangent is the last step's
    bool is_ahead = false;         ///< of the newest along its tangent, or off the only one
    bool out_of_reach = false;     ///< nearest may have left the memory: nothing else is told
};

/// The last command points of two axes, and the real-time estimate of the contour error (Li et al.,
/// eqs. (9) to (13)).
///
/// From the newest command point R_j back, while |P R_{i-1}|^2 <= |P R_i|^2, to the nearest, R_i;
/// the tangent there is t = R_{i+1} - R_{i-1}:
///
///     error = t x (P - R_i) / |t|
///
/// which is the paper's line through R_i of slope k, with a sign and without its special case of
/// the vertical. On a straight path it is exact. On one of curvature 1/R and step h it is wrong by
/// (P's foot to R_i)^2 / 2R, at most h^2 / 8R.
///
/// At the newest point R_{i+1} is not known yet: the tangent is R_i - R_{i-1}, which turns by half
/// a step's angle; likewise R_{i+1} - R_i at the first point of the path. A command that stands
/// (within 1e-12 of the newest point) adds no point, so a step is never of length 0. Where the path
/// turns back on itself (R_{i+1} = R_{i-1}) the last step is the tangent; of a path of a single
/// point the distance to it is told.
class CommandPath {
  public:
    /// Points that are remembered: 0.128 s at 0.25 ms.
    static constexpr std::int64_t capacity = 512;

    /// False when the command stands and no point was added.
    bool add(Point command);
    std::int64_t size() const { return count_ < capacity ? count_ : capacity; }
    /// `back` points before the newest, 0 .. size() - 1.
    Point point(std::int64_t back) const {
        return points_[static_cast<std::size_t>((count_ - 1 - back) & (capacity - 1))];
    }
    /// Whether so many points can have been added.
    bool is_possible() const { return count_ >= 0 && count_ < std::int64_t{1} << 62; }
    /// Nearest command point to `actual`, as points before the newest. size() is not 0.
    std::int64_t nearest(Point actual) const;
    ContourEstimate estimate(Point actual) const;

  private:
    Point tangent(std::int64_t back) const;

    std::array<Point, capacity> points_{};
    std::int64_t count_ = 0;  ///< added so far
};

}  // namespace lineshaft

#pragma once

#include <cstdint>
#include <span>

#include "blocks/path/path_course.hpp"
#include "blocks/path/path_pieces.hpp"

namespace lineshaft {

/// By how much a course exceeds its limits: the greatest quotient of what it comes to and the limit
/// that is for it, in each of its phases; bounds that hold between any samples, so that 1 and below
/// is proof. The quotients are exact up to what `near` says; phases behind the first that is above
/// 1 are looked at, too. Acceleration and jerk of a halt may come to `braking` along the path where
/// that is more than what the pieces say, and across it to what the axes allow.
bool keeps_limits(const PathPieces& pieces, const PathCourse& course, double base,
                  std::span<double> quotients, const PathLimit* braking = nullptr);

}  // namespace lineshaft

#pragma once

#include "blocks/path/path_curve.hpp"

namespace lineshaft {

/// Greatest sizes of an axis' derivatives by the length along a curve, no less than they are
/// anywhere between: of the tangent, the bend, the twist, and two more.
struct PathBound {
    double tangent = 0, bend = 0, twist = 0, fourth = 0, fifth = 0;
};

PathBound bound_of(const PathCurve& curve, std::size_t axis);

using PathBounds = std::array<PathBound, most_path_axes>;
PathBounds bounds_of(const PathCurve& curve);

/// That of the size of the whole vector of a corner in the first three axes.
PathBound bound_of_corner(const PathCurve& corner);

}  // namespace lineshaft

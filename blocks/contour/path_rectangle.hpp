#pragma once

#include <span>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Set-points of two axes on a rectangle with round corners: a closed path of straight and curved
/// parts. From the length travelled along it, counter-clockwise, beginning in the middle of the
/// lower side; `length` may go round more than once, or back. The curvature jumps between 0 and
/// 1 / corner_radius. Sides that are shorter than the corners are lengthened to twice the radius:
/// width = height = 2 radius is a circle.
struct PathRectangle {
    enum class Error : std::int64_t {
        none,
        not_finite,  ///< an input is NaN or infinite
    };

    double width = 40, height = 30, corner_radius = 5, centre_x = 0, centre_y = 0;

    double length = 0, path_velocity = 0;  // the latter set as `velocity`

    double x = 0, y = 0, velocity_x = 0, velocity_y = 0, perimeter = 0;
    bool error = false;
    Error error_id = Error::none;

    static constexpr std::string_view type = "path_rectangle";
    static constexpr std::string_view doc =
        "set-points of x and y on a rectangle with round corners, from a path length";
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

}  // namespace lineshaft

#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Set-points of two axes on a circle, from the length s travelled along it, its velocity v and its
/// acceleration a (Liu 2023, full circle):
///
///     phi = start_angle +- s / R                    + clockwise, - counter-clockwise
///     x = x_c + R sin phi,  y = y_c + R cos phi     (angle 0 is above the centre, as in Arc)
///     velocity = v t,  acceleration = a t - v^2/R n
///
/// with the unit vectors t along the path and n away from the centre. `length` may be negative and
/// may go round more than once. With an input that is no number, or whose results are none, the
/// outputs are held.
struct PathCircle {
    enum class Turn : std::int64_t { clockwise, counter_clockwise };
    enum class Error : std::int64_t {
        none,
        not_finite,  ///< an input is NaN or infinite, or what follows from it is
    };

    double radius = 20, centre_x = 0, centre_y = 0, start_angle = 0;
    Turn turn = Turn::clockwise;  // set as `direction`

    double length = 0, path_velocity = 0, path_acceleration = 0;  // set without `path_`

    double x = 0, y = 0;
    double velocity_x = 0, velocity_y = 0;
    double acceleration_x = 0, acceleration_y = 0;
    bool error = false;
    Error error_id = Error::none;

    static constexpr std::string_view type = "path_circle";
    static constexpr std::string_view doc = "set-points of x and y on a circle, from a path length";
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

}  // namespace lineshaft

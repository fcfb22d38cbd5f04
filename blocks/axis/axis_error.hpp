#pragma once

#include <cstdint>
#include <string_view>

#include "blocks/inputs.hpp"
#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

/// Why an axis set `error`. With inputs that it cannot read it holds its last good outputs and goes
/// on when they are good again; a motion that it cannot plan is refused and the one before goes on.
enum class AxisError : std::int64_t {
    none,
    not_finite,          ///< an input is NaN or infinite, or what it asks for is
    limit_not_positive,  ///< velocity, acceleration or jerk limit is zero or negative
    not_standing,        ///< positioning asked for while the axis is coupled or moves
    not_enabled,         ///< a move asked for without `enable`
};

inline constexpr std::string_view axis_error_names[] = {"none", "not_finite", "limit_not_positive",
                                                        "not_standing", "not_enabled"};

constexpr AxisError axis_error(PlanResult result) {
    if (result == PlanResult::ok) return AxisError::none;
    return result == PlanResult::not_finite ? AxisError::not_finite : AxisError::limit_not_positive;
}

/// Units an axis can be configured for, as on the controller; the master's unit of a gear likewise.
enum class AxisUnit : std::int64_t { mm, rad, deg, m, rev };

inline constexpr std::string_view axis_unit_names[] = {"mm", "rad", "deg", "m", "rev"};

}  // namespace lineshaft

#pragma once

#include <cstdint>
#include <string_view>

namespace lineshaft {

/// Units an axis can be configured for, as on the controller.
enum class AxisUnit : std::int64_t { mm, rad, deg, m, rev };

inline constexpr std::string_view axis_unit_names[] = {"mm", "rad", "deg", "m", "rev"};

/// What a vendor does otherwise than PLCopen: see blocks/motion/README.md.
enum class AxisProfile : std::int64_t { plcopen, s7_1500 };

inline constexpr std::string_view axis_profile_names[] = {"plcopen", "s7_1500"};

}  // namespace lineshaft

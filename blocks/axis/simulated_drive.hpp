#pragma once

#include <span>

#include "blocks/axis/axis_error.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// An axis in simulation, as Siemens' technology objects have it: the drive follows at once, so the
/// actual position is the set-point that was there when MC_Servo ran. In the servo task, which runs
/// *before* the interpolator at each clock, that is the set-point of one clock ago: what the user
/// program then reads.
struct SimulatedDrive {
    AxisUnit unit = AxisUnit::mm;
    double set_position = 0, set_velocity = 0;
    double position = 0, velocity = 0;

    static constexpr std::string_view type = "simulated_drive";
    static constexpr std::string_view doc = "drive in simulation: actual values are the set-points";
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

}  // namespace lineshaft

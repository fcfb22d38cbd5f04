#pragma once

#include <span>

#include "blocks/axis/axis_error.hpp"
#include "blocks/axis/positioning.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Virtual master axis: set-points without a drive.
///
/// `motion: velocity` follows the input `velocity` while `enable` is true (PLCopen
/// MC_MoveVelocity). `motion: absolute` moves to `target` at each rising edge of `execute`
/// (MC_MoveAbsolute); target and limits are taken with the edge, from whatever motion the axis is
/// in. Without `enable` the axis ramps to standstill (MC_Halt), and an edge of `execute` is
/// refused. Velocity changes are S-curves under `acceleration` and `jerk` as they are when the
/// wanted velocity changes; other limits in mid-ramp count from the next change on. With
/// `immediate` they take no time, as the set-point of a virtual axis may. Positions come from the
/// closed form of each phase, not from summing up: they do not drift. `home` sets the position of a
/// standing axis (MC_Home, direct).
struct VirtualAxis {
    enum class Motion : std::int64_t { velocity, absolute };

    AxisUnit unit = AxisUnit::mm;
    Motion motion = Motion::velocity;
    bool immediate = false;
    double start_position = 0;

    bool enable = true;
    double wanted_velocity = 0;                         // set as `velocity`
    double acceleration_limit = 100, jerk_limit = 5e4;  // set as `acceleration`, `jerk`
    bool execute = false;
    double target = 0;
    bool home = false;
    double home_position = 0;

    double position = 0;
    double velocity = 0, acceleration = 0;
    bool moving = false, done = false, error = false;
    AxisError error_id = AxisError::none;

    enum class Phase : std::int64_t { constant, ramp, positioning, immediate_move };
    Phase phase = Phase::constant;
    bool first_scan = true, last_execute = false, last_home = false;
    std::int64_t phase_start = 0;
    double phase_position = 0, phase_velocity = 0, ramp_goal = 0;
    VelocityRamp ramp;
    Positioning move;

    static constexpr std::string_view type = "virtual_axis";
    static constexpr std::string_view doc = "virtual master axis: velocity or absolute motion";
    static std::span<const Field> fields();
    void scan(const Scan& now);
    void shift(std::int64_t by) {
        phase_start += by;
        move.shift(by);
    }

  private:
    AxisError check() const;
    AxisError advance(std::int64_t time);
    AxisError command(std::int64_t time);
    void begin_constant(std::int64_t time, double from, double at_velocity);
    AxisError follow_velocity(std::int64_t time, double goal);
    AxisError begin_move(std::int64_t time);
    AxisError end_move(std::int64_t time);
    AxisError set(const MotionState& state);
};

}  // namespace lineshaft

#pragma once

#include <span>

#include "blocks/axis/axis_error.hpp"
#include "blocks/axis/positioning.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Slave axis coupled to a master: velocity = ratio * master velocity once synchronous (MC_GearIn).
///
/// Every change of `ratio` is a new gear-in job that takes the acceleration and jerk of that scan
/// with it. The job ramps the *slave's* velocity by an S-curve, from whatever velocity and
/// acceleration it has, to ratio * master velocity; so also in mid-transition. Synchronous, the
/// position is rigid: anchor + ratio * (master - anchor's master), and so are velocity and
/// acceleration. Where `master_acceleration` is not wired it counts as 0: a ratio that changes
/// while the master accelerates then starts its ramp from a false state, with a step in the
/// acceleration.
///
/// A ramp ends at a constant velocity. In a transition, a master that changes its velocity is
/// followed by a new ramp each scan; while it accelerates the slave lags behind and does not get in
/// gear, but at the end of a ramp after the master's acceleration has ended.
///
/// The coupling is relative: against a slave that changed at once, a transition of duration T loses
///     d = -dv T / 2            (Wei et al. 2025, eq. (11))
/// which is never made up.
///
/// At ratio 0 the axis is free: `move` positions it absolutely, `home` sets its position (MC_Home,
/// direct).
struct GearAxis {
    AxisUnit unit = AxisUnit::mm, master_unit = AxisUnit::mm;
    double start_position = 0;

    double master_position = 0, master_velocity = 0, master_acceleration = 0;
    double ratio = 0;
    double acceleration_limit = 100, jerk_limit = 5e4;  // set as `acceleration`, `jerk`
    bool home = false;
    double home_position = 0;
    bool move = false;
    double target = 0, move_velocity = 50;

    double position = 0;
    double velocity = 0, acceleration = 0;
    bool in_gear = false, moving = false, error = false;
    AxisError error_id = AxisError::none;

    enum class Phase : std::int64_t { synchronous, transition, positioning };
    Phase phase = Phase::synchronous;
    bool first_scan = true, last_home = false, last_move = false;
    struct Job {
        double ratio = 0, acceleration = 100, jerk = 5e4;
    };
    Job job;
    double anchor_position = 0, anchor_master = 0;
    std::int64_t ramp_start = 0;
    double ramp_position = 0, ramp_goal = 0;
    VelocityRamp ramp;
    Positioning positioning;

    static constexpr std::string_view type = "gear_axis";
    static constexpr std::string_view doc =
        "slave axis geared to a master, with S-curve transitions";
    static std::span<const Field> fields();
    void scan(const Scan& now);
    void shift(std::int64_t by) {
        ramp_start += by;
        positioning.shift(by);
    }

  private:
    AxisError check() const;
    AxisError advance(std::int64_t time);
    AxisError ride_ramp(std::int64_t time, double t);
    AxisError command(std::int64_t time);
    AxisError begin_job(std::int64_t time);
    AxisError begin_transition(std::int64_t time);
    AxisError begin_positioning(std::int64_t time);
    void anchor(double at_position, double at_master);
    AxisError set(const MotionState& state);
};

}  // namespace lineshaft

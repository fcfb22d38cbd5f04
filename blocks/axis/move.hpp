#pragma once

#include <span>

#include "blocks/axis/axis_error.hpp"
#include "blocks/axis/positioning.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Why a move set `error`. While an input or an output would be no number, or a limit is not above
/// 0, outputs are held and the block goes on when the inputs are good again. A move that is refused
/// leaves the motion before as it is; its error stays until `execute` falls.
enum class MoveError : std::int64_t {
    none,
    not_finite,            ///< an input is NaN or infinite, or what it asks for is
    limit_not_positive,    ///< velocity, acceleration or jerk limit is zero or negative
    velocity_above_limit,  ///< the end velocity is not in 0..`velocity`
};

/// An axis that moves in seven segments (Liu 2023, see profile/seven_segment.hpp), from `position`
/// to the wanted one in the shortest time (PLCopen MC_MoveContinuousAbsolute; with `end_velocity` 0
/// MC_MoveAbsolute).
///
/// A rising edge of `execute` takes the inputs and starts the move from whatever state the axis
/// then has: at standstill, in the cruise of a move or after its end in seven segments; in
/// mid-ramp, away from the wanted position or above the velocity limit in the least time from that
/// state (profile/any_state.hpp; its case is `from_any_state`, its equation 0). `end_velocity`
/// counts in the direction of the move. If the way of seven segments is too short for it the axis
/// passes the wanted position with the velocity that it can reach; `in_end_velocity` tells.
///
/// After the end the axis keeps the velocity that it has: with `end_velocity` 0 it stands exactly
/// at the wanted position; above 0 it has passed it between two scans and moves on until the next
/// move. Before the first move it runs at `start_velocity` from `start_position`.
///
/// `busy`, `done` and `error` exclude each other: `busy` until the end of the move, then `done` as
/// long as `execute` is true, one scan at least.
///
/// What the planner found is on the outputs from the start of the move: its case, the number of the
/// equation in the paper, its duration, what the segments' times miss the distance by, and the
/// greatest velocity and acceleration, whatever the scans see of them.
struct Move {
    AxisUnit unit = AxisUnit::mm;
    double start_position = 0, start_velocity = 0;

    bool execute = false;
    double target = 0;                                                       // set as `position`
    double velocity_limit = 50, acceleration_limit = 100, jerk_limit = 5e4;  // set without `_limit`
    double end_velocity = 0;

    double position = 0, velocity = 0, acceleration = 0, jerk = 0;
    bool done = false, busy = false, in_end_velocity = false, error = false;
    MoveError error_id = MoveError::none;
    MoveKind kind = MoveKind::accelerate_triangular;
    std::int64_t equation = 0;  ///< 0: no move yet
    double duration = 0, displacement_error = 0;
    double greatest_velocity = 0, greatest_acceleration = 0;

    bool first_scan = true, last_execute = false, told = false;
    bool started = false;  ///< there is a move, under way or done
    std::int64_t first_time = 0;
    MoveError refusal = MoveError::none;
    Positioning positioning;

    static constexpr std::string_view type = "move";
    static constexpr std::string_view doc = "axis that moves in seven segments of constant jerk";
    static std::span<const Field> fields();
    void scan(const Scan& now);
    void shift(std::int64_t by) {
        first_time += by;
        positioning.shift(by);
    }

  private:
    MoveError check() const;
    MoveError advance(std::int64_t time);
    void command(std::int64_t time);
    MoveError begin(std::int64_t time);
    void publish_plan();
    void publish_state(std::int64_t time);
    MoveError set(const MotionState& state);
};

}  // namespace lineshaft

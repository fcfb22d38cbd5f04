#pragma once

#include <cstdint>
#include <span>

#include "blocks/axis/axis_unit.hpp"
#include "blocks/profile/seven_segment.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Why a move along a path was refused; its error stays until `execute` falls.
enum class PathMoveError : std::int64_t {
    none,
    not_finite,            ///< an input is NaN or infinite, or what it asks for is
    negative_length,       ///< there is no way of that length
    limit_not_positive,    ///< a limit of velocity, acceleration or jerk is zero or negative
    velocity_above_limit,  ///< start or end velocity is not in 0..`velocity_limit`
};

/// The way along a path over time: one move in the seven segments of Liu 2023
/// (profile/seven_segment.hpp), for path_circle and path_rectangle.
///
/// A rising edge of `execute` takes the inputs and begins the move at position 0. `busy` until its
/// end, then `done` as long as `execute` is true, one scan at least. While an input is no number
/// the outputs are held. After the end the velocity
/// stays: 0, or `end_velocity`, or what the length sufficed for.
///
/// What the planner found is on the outputs from the start of the move: its case, the number of the
/// equation in the paper, its duration, what the segments' times miss the length by, and the
/// greatest velocity and acceleration, whatever the scans see of them.
struct PathMove {
    AxisUnit unit = AxisUnit::mm;
    double start_velocity = 0;

    bool execute = false;
    double length = 0, velocity_limit = 50, acceleration_limit = 100, jerk_limit = 5e4;
    double end_velocity = 0;

    double position = 0, velocity = 0, acceleration = 0, jerk = 0;
    bool done = false, busy = false, error = false;
    PathMoveError error_id = PathMoveError::none;
    MoveKind kind = MoveKind::accelerate_triangular;
    std::int64_t equation = 0;  ///< 0: no move yet
    double duration = 0, displacement_error = 0;
    double greatest_velocity = 0, greatest_acceleration = 0;

    bool last_execute = false, told = false;
    bool started = false;  ///< there is a move, under way or done
    std::int64_t start_time = 0;
    SevenSegmentPlan plan;

    static constexpr std::string_view type = "path_move";
    static constexpr std::string_view doc = "way along a path, in seven segments of constant jerk";
    static std::span<const Field> fields();
    void scan(const Scan& now);
    void shift(std::int64_t by) { start_time += by; }

  private:
    PathMoveError begin(std::int64_t time);
    void publish_plan();
    void publish_motion(std::int64_t time);
    void publish_state(std::int64_t time);
};

}  // namespace lineshaft

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace lineshaft {

/// States of an axis (PLCopen Part 1 v2.0, 2.1).
enum class AxisState : std::int64_t {
    disabled,
    standstill,
    homing,
    stopping,
    discrete_motion,
    continuous_motion,
    synchronized_motion,
    error_stop,
};

inline constexpr std::size_t axis_state_count = 8;
inline constexpr std::string_view axis_state_names[axis_state_count] = {
    "disabled",          "standstill",          "homing",    "stopping", "discrete_motion",
    "continuous_motion", "synchronized_motion", "error_stop"};

/// What may be asked of an axis; each but the first is a row of the table of states.
enum class Command : std::int64_t {
    none,
    power_on,
    power_off,
    reset,
    home,
    stop,
    halt,
    move_absolute,
    move_relative,
    move_additive,
    move_superimposed,
    halt_superimposed,
    move_velocity,
    move_continuous_absolute,
    move_continuous_relative,
    position_profile,
    velocity_profile,
    acceleration_profile,
    motion_in_position,
    set_position,
    set_override,
    write_parameter,
    write_bool_parameter,
    abort_trigger,
    gear_in,
    gear_out,
    gear_in_pos,
    cam_in,
    cam_out,
    phasing_absolute,
    phasing_relative,
    combine_axes,
};

/// A row: what becomes of an axis in each state that takes up the command with mode Aborting;
/// empty where it is refused.
struct StateRow {
    Command command = Command::none;
    std::string_view name;  ///< `MC_MoveAbsolute`, `MC_Power, Enable`
    std::optional<AxisState> next[axis_state_count];
};

/// All commands, in the order of the enumeration.
std::span<const StateRow> state_table();

/// Whether the command has a BufferMode, and waits by it for one before (table 4; of MC_Phasing,
/// which waits for another MC_Phasing alone, see Axis::take).
bool can_be_buffered(Command command);

/// Whether a command at work in the state may be waited for: of MC_Stop until it is done AND its
/// Execute false (table 4).
bool can_be_followed(AxisState state);

/// Empty: the command is refused.
std::optional<AxisState> next_state(Command command, AxisState now);

}  // namespace lineshaft

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace lineshaft {

/// States of a group of axes (PLCopen Part 4 v1.0).
enum class GroupState : std::int64_t { disabled, standby, moving, homing, stopping, error_stop };

inline constexpr std::size_t group_state_count = 6;
inline constexpr std::string_view group_state_names[group_state_count] = {
    "disabled", "standby", "moving", "homing", "stopping", "error_stop"};

/// What may be asked of a group; each but the first is a row of the table of states.
enum class GroupCommand : std::int64_t {
    none,
    add_axis,
    remove_axis,
    ungroup,
    enable,
    disable,
    reset,
    stop,
    halt,
    interrupt,
    go_on,
    set_override,
    set_transform,
    power,
    move_linear_absolute,
    move_linear_relative,
    move_circular_absolute,
    move_circular_relative,
    move_direct_absolute,
    move_direct_relative,
    move_path,
};

/// A row: what becomes of a group in each state that takes up the command; empty where it is
/// refused.
struct GroupStateRow {
    GroupCommand command = GroupCommand::none;
    std::string_view name;  ///< `MC_MoveLinearAbsolute`
    std::optional<GroupState> next[group_state_count];
};

/// All commands, in the order of the enumeration.
std::span<const GroupStateRow> group_state_table();

/// Empty: the command is refused.
std::optional<GroupState> next_state(GroupCommand command, GroupState now);

/// Whether it leads along a path.
constexpr bool is_move(GroupCommand command) {
    return command >= GroupCommand::move_linear_absolute;
}

}  // namespace lineshaft

#pragma once

#include "blocks/group/group_command.hpp"

namespace lineshaft {

namespace group_kinds {

std::span<const Field> move_absolute_fields();
std::span<const Field> move_relative_fields();
std::span<const Field> circle_absolute_fields();
std::span<const Field> circle_relative_fields();
std::span<const Field> direct_absolute_fields();
std::span<const Field> direct_relative_fields();

inline constexpr GroupCommandKind linear_absolute{
    GroupCommand::move_linear_absolute, "MC_MoveLinearAbsolute",
    "moves a group on a line to a position", move_absolute_fields};
inline constexpr GroupCommandKind linear_relative{
    GroupCommand::move_linear_relative, "MC_MoveLinearRelative",
    "moves a group on a line by a distance", move_relative_fields};
inline constexpr GroupCommandKind circular_absolute{
    GroupCommand::move_circular_absolute, "MC_MoveCircularAbsolute",
    "moves a group on an arc to a position", circle_absolute_fields};
inline constexpr GroupCommandKind circular_relative{
    GroupCommand::move_circular_relative, "MC_MoveCircularRelative",
    "moves a group on an arc, its points from where "
    "it begins",
    circle_relative_fields};
inline constexpr GroupCommandKind direct_absolute{GroupCommand::move_direct_absolute,
                                                  "MC_MoveDirectAbsolute",
                                                  "moves a group to a position as fast as its axes "
                                                  "can, whatever the way",
                                                  direct_absolute_fields};
inline constexpr GroupCommandKind direct_relative{GroupCommand::move_direct_relative,
                                                  "MC_MoveDirectRelative",
                                                  "moves a group by a distance as fast as its axes "
                                                  "can, whatever the way",
                                                  direct_relative_fields};

}  // namespace group_kinds

using MoveLinearAbsolute = PlainGroupCommand<group_kinds::linear_absolute>;
using MoveLinearRelative = PlainGroupCommand<group_kinds::linear_relative>;
using MoveCircularAbsolute = PlainGroupCommand<group_kinds::circular_absolute>;
using MoveCircularRelative = PlainGroupCommand<group_kinds::circular_relative>;
using MoveDirectAbsolute = PlainGroupCommand<group_kinds::direct_absolute>;
using MoveDirectRelative = PlainGroupCommand<group_kinds::direct_relative>;

/// MC_MovePath: along all points of a path_table.
struct MovePath : GroupCommandBlock {
    static constexpr std::string_view type = "MC_MovePath";
    static constexpr std::string_view doc = "moves a group along the points of a table";
    static std::span<const Field> fields();
    constexpr MovePath() { pins.command = GroupCommand::move_path; }
    void scan(const Scan& now, const Context& context);

    std::int64_t path_data = nowhere;
};

}  // namespace lineshaft

#include "blocks/group/group_states.hpp"

namespace lineshaft {

namespace {

using G = GroupCommand;

constexpr std::nullopt_t no = std::nullopt;
constexpr GroupState Dis = GroupState::disabled, Sby = GroupState::standby,
                     Mov = GroupState::moving, Hom = GroupState::homing, Stp = GroupState::stopping,
                     Err = GroupState::error_stop;

// clang-format off
constexpr GroupStateRow group_rows[] = {
    //                                                      in Dis  Sby  Mov  Hom  Stp  Err
    {G::add_axis,               "MC_AddAxisToGroup",          {Dis, Sby, no,  no,  no,  Err}},
    {G::remove_axis,            "MC_RemoveAxisFromGroup",     {Dis, Sby, no,  no,  no,  Err}},
    {G::ungroup,                "MC_UngroupAllAxes",          {Dis, Dis, Dis, Dis, Dis, Dis}},
    {G::enable,                 "MC_GroupEnable",             {Sby, Sby, Mov, Hom, Stp, no }},
    {G::disable,                "MC_GroupDisable",            {Dis, Dis, Dis, Dis, Dis, Dis}},
    {G::reset,                  "MC_GroupReset",              {Dis, Sby, Mov, Hom, Stp, Sby}},
    {G::stop,                   "MC_GroupStop",               {no,  Stp, Stp, Stp, no,  no }},
    {G::halt,                   "MC_GroupHalt",               {no,  Mov, Mov, no,  no,  no }},
    {G::interrupt,              "MC_GroupInterrupt",          {no,  no,  Mov, no,  no,  no }},
    {G::go_on,                  "MC_GroupContinue",           {no,  Mov, Mov, no,  no,  no }},
    {G::set_override,           "MC_GroupSetOverride",        {Dis, Sby, Mov, Hom, Stp, Err}},
    {G::set_transform,          "MC_SetCartesianTransform",   {Dis, Sby, Mov, Hom, Stp, Err}},
    {G::power,                  "MC_GroupPower",              {Dis, Sby, Mov, Hom, Stp, Err}},
    {G::move_linear_absolute,   "MC_MoveLinearAbsolute",      {no,  Mov, Mov, no,  no,  no }},
    {G::move_linear_relative,   "MC_MoveLinearRelative",      {no,  Mov, Mov, no,  no,  no }},
    {G::move_circular_absolute, "MC_MoveCircularAbsolute",    {no,  Mov, Mov, no,  no,  no }},
    {G::move_circular_relative, "MC_MoveCircularRelative",    {no,  Mov, Mov, no,  no,  no }},
    {G::move_direct_absolute,   "MC_MoveDirectAbsolute",      {no,  Mov, Mov, no,  no,  no }},
    {G::move_direct_relative,   "MC_MoveDirectRelative",      {no,  Mov, Mov, no,  no,  no }},
    {G::move_path,              "MC_MovePath",                {no,  Mov, Mov, no,  no,  no }},
};
// clang-format on

constexpr bool are_in_order() {
    for (std::size_t i = 0; i < std::size(group_rows); ++i)
        if (static_cast<std::size_t>(group_rows[i].command) != i + 1) return false;
    return true;
}
static_assert(are_in_order());

}  // namespace

std::span<const GroupStateRow> group_state_table() {
    return group_rows;
}

std::optional<GroupState> next_state(GroupCommand command, GroupState now) {
    if (command == GroupCommand::none) return {};
    return group_rows[static_cast<std::size_t>(command) - 1].next[static_cast<std::size_t>(now)];
}

}  // namespace lineshaft

#include "blocks/axis/axis_states.hpp"

namespace lineshaft {

namespace {

using C = Command;

constexpr std::nullopt_t no = std::nullopt;
constexpr AxisState Dis = AxisState::disabled, Std = AxisState::standstill, Hom = AxisState::homing,
                    Stp = AxisState::stopping, Dsc = AxisState::discrete_motion,
                    Con = AxisState::continuous_motion, Syn = AxisState::synchronized_motion,
                    Err = AxisState::error_stop;

// clang-format off
constexpr StateRow rows[] = {
    //                                                          in Dis  Std  Hom  Stp  Dsc  Con  Syn  Err
    {C::power_on,                 "MC_Power, Enable",              {Std, Std, Hom, Stp, Dsc, Con, Syn, Err}},
    {C::power_off,                "MC_Power, not Enable",          {Dis, Dis, Dis, Dis, Dis, Dis, Dis, Err}},
    {C::reset,                    "MC_Reset",                      {Dis, Std, Hom, Stp, Dsc, Con, Syn, Std}},
    {C::home,                     "MC_Home",                       {no,  Hom, no,  no,  no,  no,  no,  no }},
    {C::stop,                     "MC_Stop",                       {no,  Stp, Stp, no,  Stp, Stp, Stp, no }},
    {C::halt,                     "MC_Halt",                       {no,  Dsc, no,  no,  Dsc, Dsc, Dsc, no }},
    {C::move_absolute,            "MC_MoveAbsolute",               {no,  Dsc, no,  no,  Dsc, Dsc, Dsc, no }},
    {C::move_relative,            "MC_MoveRelative",               {no,  Dsc, no,  no,  Dsc, Dsc, Dsc, no }},
    {C::move_additive,            "MC_MoveAdditive",               {no,  Dsc, no,  no,  Dsc, Dsc, Dsc, no }},
    {C::move_superimposed,        "MC_MoveSuperimposed",           {no,  Dsc, no,  no,  Dsc, Con, Syn, no }},
    {C::halt_superimposed,        "MC_HaltSuperimposed",           {no,  Std, no,  no,  Dsc, Con, Syn, no }},
    {C::move_velocity,            "MC_MoveVelocity",               {no,  Con, no,  no,  Con, Con, Con, no }},
    {C::move_continuous_absolute, "MC_MoveContinuousAbsolute",     {no,  Con, no,  no,  Con, Con, Con, no }},
    {C::move_continuous_relative, "MC_MoveContinuousRelative",     {no,  Con, no,  no,  Con, Con, Con, no }},
    {C::position_profile,         "MC_PositionProfile",            {no,  Dsc, no,  no,  Dsc, Dsc, Dsc, no }},
    {C::velocity_profile,         "MC_VelocityProfile",            {no,  Con, no,  no,  Con, Con, Con, no }},
    {C::acceleration_profile,     "MC_AccelerationProfile",        {no,  Con, no,  no,  Con, Con, Con, no }},
    {C::motion_in_position,       "MC_MotionInPosition, Enable",   {no,  Syn, no,  no,  Syn, Syn, Syn, no }},
    {C::set_position,             "MC_SetPosition",                {Dis, Std, no,  Stp, Dsc, Con, Syn, Err}},
    {C::set_override,             "MC_SetOverride",                {Dis, Std, Hom, Stp, Dsc, Con, Syn, Err}},
    {C::write_parameter,          "MC_WriteParameter",             {Dis, Std, Hom, Stp, Dsc, Con, Syn, Err}},
    {C::write_bool_parameter,     "MC_WriteBoolParameter",         {Dis, Std, Hom, Stp, Dsc, Con, Syn, Err}},
    {C::abort_trigger,            "MC_AbortTrigger",               {Dis, Std, Hom, Stp, Dsc, Con, Syn, Err}},
    {C::gear_in,                  "MC_GearIn",                     {no,  Syn, no,  no,  Syn, Syn, Syn, no }},
    {C::gear_out,                 "MC_GearOut",                    {no,  no,  no,  no,  no,  no,  Con, no }},
    {C::gear_in_pos,              "MC_GearInPos",                  {no,  Syn, no,  no,  Syn, Syn, Syn, no }},
    {C::cam_in,                   "MC_CamIn",                      {no,  Syn, no,  no,  Syn, Syn, Syn, no }},
    {C::cam_out,                  "MC_CamOut",                     {no,  no,  no,  no,  no,  no,  Con, no }},
    {C::phasing_absolute,         "MC_PhasingAbsolute",            {no,  no,  no,  no,  no,  no,  Syn, no }},
    {C::phasing_relative,         "MC_PhasingRelative",            {no,  no,  no,  no,  no,  no,  Syn, no }},
    {C::combine_axes,             "MC_CombineAxes",                {no,  Syn, no,  no,  Syn, Syn, Syn, no }},
};
// clang-format on

constexpr bool in_order() {
    for (std::size_t i = 0; i < std::size(rows); ++i)
        if (static_cast<std::size_t>(rows[i].command) != i + 1) return false;
    return true;
}
static_assert(in_order());

}  // namespace

std::span<const StateRow> state_table() {
    return rows;
}

bool can_be_buffered(Command command) {
    switch (command) {
        case C::home:
        case C::halt:
        case C::move_absolute:
        case C::move_relative:
        case C::move_additive:
        case C::move_velocity:
        case C::move_continuous_absolute:
        case C::move_continuous_relative:
        case C::position_profile:
        case C::velocity_profile:
        case C::acceleration_profile:
        case C::gear_in:
        case C::gear_in_pos:
        case C::cam_in:
        case C::combine_axes:
            return true;
        case C::none:
        case C::power_on:
        case C::power_off:
        case C::reset:
        case C::stop:
        case C::move_superimposed:
        case C::halt_superimposed:
        case C::motion_in_position:
        case C::set_position:
        case C::set_override:
        case C::write_parameter:
        case C::write_bool_parameter:
        case C::abort_trigger:
        case C::gear_out:
        case C::cam_out:
        case C::phasing_absolute:
        case C::phasing_relative:
            break;
    }
    return false;
}

bool can_be_followed(AxisState state) {
    return state >= AxisState::homing && state <= AxisState::synchronized_motion;
}

std::optional<AxisState> next_state(Command command, AxisState now) {
    if (command == Command::none) return {};
    return rows[static_cast<std::size_t>(command) - 1].next[static_cast<std::size_t>(now)];
}

}  // namespace lineshaft

#pragma once

#include "blocks/motion/command.hpp"

namespace lineshaft {

/// Commands of one motion (PLCopen Part 1 v2.0, 3.4 to 3.12). The pins say all.
namespace command_kinds {

std::span<const Field> absolute_fields();
std::span<const Field> distance_fields();
std::span<const Field> velocity_fields();
std::span<const Field> continuous_absolute_fields();
std::span<const Field> continuous_relative_fields();
std::span<const Field> halt_fields();
std::span<const Field> halt_superimposed_fields();

inline constexpr CommandKind move_absolute{Command::move_absolute, "MC_MoveAbsolute",
                                           "moves an axis to a position", absolute_fields};
inline constexpr CommandKind move_relative{Command::move_relative, "MC_MoveRelative",
                                           "moves an axis by a distance from where it is",
                                           distance_fields};
inline constexpr CommandKind move_additive{Command::move_additive, "MC_MoveAdditive",
                                           "moves an axis by a distance from its last target",
                                           distance_fields};
inline constexpr CommandKind move_velocity{Command::move_velocity, "MC_MoveVelocity",
                                           "moves an axis on and on", velocity_fields};
inline constexpr CommandKind move_continuous_absolute{
    Command::move_continuous_absolute, "MC_MoveContinuousAbsolute",
    "moves an axis through a position, and on with a velocity", continuous_absolute_fields};
inline constexpr CommandKind move_continuous_relative{
    Command::move_continuous_relative, "MC_MoveContinuousRelative",
    "moves an axis by a distance, and on with a velocity", continuous_relative_fields};
inline constexpr CommandKind halt{Command::halt, "MC_Halt",
                                  "brings an axis to standstill; other commands may take over",
                                  halt_fields};
inline constexpr CommandKind halt_superimposed{Command::halt_superimposed, "MC_HaltSuperimposed",
                                               "brings what is superimposed to standstill",
                                               halt_superimposed_fields};

}  // namespace command_kinds

using MoveAbsolute = PlainCommand<command_kinds::move_absolute>;
using MoveRelative = PlainCommand<command_kinds::move_relative>;
using MoveAdditive = PlainCommand<command_kinds::move_additive>;
using MoveVelocity = PlainCommand<command_kinds::move_velocity>;
using MoveContinuousAbsolute = PlainCommand<command_kinds::move_continuous_absolute>;
using MoveContinuousRelative = PlainCommand<command_kinds::move_continuous_relative>;
using Halt = PlainCommand<command_kinds::halt>;
using HaltSuperimposed = PlainCommand<command_kinds::halt_superimposed>;

/// MC_MoveSuperimposed (3.8): on top of the motion that is at work. CoveredDistance is what it has
/// added so far; where another command ends it, what it has added until then.
struct MoveSuperimposed : CommandBlock {
    double covered_distance = 0;

    static constexpr std::string_view type = "MC_MoveSuperimposed";
    static constexpr std::string_view doc = "adds a distance to the motion of an axis";
    static std::span<const Field> fields();
    constexpr MoveSuperimposed() { pins.command = Command::move_superimposed; }
    void scan(const Scan& now, const Context& context);
};

/// MC_MotionInPosition of Siemens: the program says in each scan where the axis is, as a planner of
/// its own has it. The axis takes that as its set-point in its next scan, without looking at
/// velocities or accelerations; where none comes it goes on as the last one says. A falling Enable
/// makes it brake with its defaults.
struct MotionInPosition : CommandBlock {
    static constexpr std::string_view type = "MC_MotionInPosition";
    static constexpr std::string_view doc = "leads an axis by set-points, scan by scan";
    static std::span<const Field> fields();
    constexpr MotionInPosition() {
        pins.command = Command::motion_in_position;
        pins.velocity = pins.acceleration = 0;
    }
    void scan(const Scan& now, const Context& context);
};

}  // namespace lineshaft

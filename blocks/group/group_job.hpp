#pragma once

#include <cstdint>
#include <string_view>

#include "blocks/axis/job.hpp"
#include "blocks/group/group_states.hpp"
#include "blocks/path/path_frame.hpp"

namespace lineshaft {

/// How the corner before a blended move is rounded (PLCopen Part 4 v1.0, TransitionMode).
enum class CornerMode : std::int64_t { none, start_velocity, corner_distance, corner_deviation };

inline constexpr std::string_view corner_mode_names[] = {
    "mcTMNone", "mcTMStartVelocity", "mcTMCornerDistance", "mcTMMaxCornerDeviation"};

/// What AuxPoint of a circular move is: a point of the arc, its centre, or the tip of a vector from
/// the start that stands upright on the plane and is as long as the radius.
enum class CircleMode : std::int64_t { border, centre, radius };

inline constexpr std::string_view circle_mode_names[] = {"mcBorder", "mcCenter", "mcRadius"};

/// In which coordinates positions are: those of the axes, which are the machine's, or those of the
/// product, as MC_SetCartesianTransform places it.
enum class CoordSystem : std::int64_t { axes, machine, product };

inline constexpr std::string_view coord_system_names[] = {"mcACS", "mcMCS", "mcPCS"};

enum class PathChoice : std::int64_t { clockwise, counter_clockwise };

inline constexpr std::string_view path_choice_names[] = {"mcClockwise", "mcCounterClockwise"};

/// What a command asks of its group, in the group's unit; rotary axes in degrees. Dynamics below 0
/// are the group's own.
struct GroupRequest {
    GroupCommand command = GroupCommand::none;
    BufferMode mode = BufferMode::aborting;
    CornerMode corner = CornerMode::none;
    double corner_parameter = 0;  ///< [u], of start_velocity [u/s]
    CircleMode circle = CircleMode::border;
    PathChoice choice = PathChoice::clockwise;
    CoordSystem coordinates = CoordSystem::machine;
    PathVector target{};     ///< position or distance
    PathVector auxiliary{};  ///< AuxPoint
    PathVector transform{};  ///< of MC_SetCartesianTransform: shift [u], angles [deg]
    double velocity = -1, acceleration = -1, deceleration = -1, jerk = -1;
    std::int64_t holds = 0;                  ///< Execute of MC_GroupStop
    std::int64_t is_enabled = 0;             ///< Enable of MC_GroupPower
    std::int64_t frees = 0;                  ///< FreesGroup of MC_GroupInterrupt
    std::int64_t axis = nowhere, place = 1;  ///< of MC_AddAxisToGroup; IdentInGroup
    std::int64_t table = nowhere;            ///< of MC_MovePath
    double velocity_factor = 1, acceleration_factor = 1, jerk_factor = 1;  ///< override

    bool operator==(const GroupRequest&) const = default;
};

/// A job for a group. Of a move in the queue: the pieces of the path that are its own, and how much
/// of its table has been put into the path.
struct GroupJob : JobState {
    GroupRequest request;
    PathFrame frame;  ///< of a move: where its coordinates stand, since it was taken up
    std::int64_t first_piece = 0, end_piece = 0;
    std::int64_t rows = 0;
    PathVector start{};         ///< of a table: where it begins, in the coordinates of its points
    std::int64_t is_laid = 0;   ///< all of it is in the path
    std::int64_t is_aside = 0;  ///< in the queue of a path that has been left for others

    constexpr GroupJob() { whom = JobFor::group; }
};

}  // namespace lineshaft

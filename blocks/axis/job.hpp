#pragma once

#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

#include "blocks/axis/axis_states.hpp"
#include "blocks/axis/command_rules.hpp"
#include "blocks/axis/coupling.hpp"
#include "blocks/axis/look_ahead.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// When a command takes effect that finds another one at work (PLCopen Part 1 v2.0, 2.4.2). All but
/// `aborting` wait for the end of the one before; blending passes its end position with the lowest,
/// the previous, the next or the highest velocity of the two.
enum class BufferMode : std::int64_t {
    aborting,
    buffered,
    blending_low,
    blending_previous,
    blending_next,
    blending_high,
};

inline constexpr std::string_view buffer_mode_names[] = {"mcAborting",     "mcBuffered",
                                                         "mcBlendingLow",  "mcBlendingPrevious",
                                                         "mcBlendingNext", "mcBlendingHigh"};

/// When a command takes effect that sets something: at once, or as a buffered one.
inline constexpr std::string_view execution_mode_names[] = {"mcImmediately", "mcQueued"};

/// The way to a position of a modulo axis.
enum class MoveDirection : std::int64_t { shortest_way, positive, negative, current };

inline constexpr std::string_view move_direction_names[] = {
    "mcShortestWay", "mcPositiveDirection", "mcNegativeDirection", "mcCurrentDirection"};

/// Why an axis or a command set its error: see motion_error_texts.
enum class MotionError : std::int64_t {
    none,
    no_axis,
    not_finite,
    limit_not_positive,
    out_of_range,
    axis_disabled,
    axis_stopping,
    axis_homing,
    axis_in_error,
    wrong_state,
    software_limit,
    no_master,
    master_loop,
    master_stands,
    sync_passed,
    sync_limits,
    no_cam,
    no_such_parameter,
    direction_not_enabled,
    no_reference,
    other_unit,
    axis_in_group,
    no_group,
    group_disabled,
    group_stopping,
    group_in_error,
    too_few_axes,
    already_in_group,
    unit_of_group,
    task_of_group,
    axis_moves,
    axis_left_path,
    no_arc,
    buffer_full,
    not_where_interrupted,
    no_blending,
    not_called,
};

inline constexpr std::string_view motion_error_names[] = {"none",
                                                          "no_axis",
                                                          "not_finite",
                                                          "limit_not_positive",
                                                          "out_of_range",
                                                          "axis_disabled",
                                                          "axis_stopping",
                                                          "axis_homing",
                                                          "axis_in_error",
                                                          "wrong_state",
                                                          "software_limit",
                                                          "no_master",
                                                          "master_loop",
                                                          "master_stands",
                                                          "sync_passed",
                                                          "sync_limits",
                                                          "no_cam",
                                                          "no_such_parameter",
                                                          "direction_not_enabled",
                                                          "no_reference",
                                                          "other_unit",
                                                          "axis_in_group",
                                                          "no_group",
                                                          "group_disabled",
                                                          "group_stopping",
                                                          "group_in_error",
                                                          "too_few_axes",
                                                          "already_in_group",
                                                          "unit_of_group",
                                                          "task_of_group",
                                                          "axis_moves",
                                                          "axis_left_path",
                                                          "no_arc",
                                                          "buffer_full",
                                                          "not_where_interrupted",
                                                          "no_blending",
                                                          "not_called"};

inline constexpr std::string_view motion_error_texts[] = {
    "",
    "the command refers to no axis",
    "an input is NaN or infinite, or what it asks for is",
    "velocity, acceleration, deceleration or jerk is not above 0",
    "an input is outside of what it may be",
    "the axis has no power, which MC_Power gives",
    "MC_Stop holds the axis until its Execute is false",
    "the axis is homing",
    "the axis is in ErrorStop, which MC_Reset ends",
    "the command does not go with what the axis is doing",
    "the way leads beyond the axis' software limits",
    "the command refers to no master",
    "the master follows the slave, over however many others",
    "a slave in motion cannot get in sync with a master that stands",
    "the master is beyond the position where it was to be met",
    "the coupling takes more velocity, acceleration or jerk than the command allows, or where it "
    "says nothing the axis' default_velocity and so on",
    "CamTableID is not that of a cam table",
    "the axis has no parameter of that number",
    "MC_Power does not enable the direction of the way, with EnablePositive or EnableNegative",
    "a reference of the block names nothing",
    "what the block refers to is in another unit than its axis",
    "the axis follows a group in motion, whose commands move it: MC_GroupStop or MC_GroupHalt "
    "stops it",
    "the command refers to no group",
    "the group is disabled, which MC_GroupEnable ends",
    "MC_GroupStop holds the group until its Execute is false",
    "the group is in GroupErrorStop, which MC_GroupReset ends",
    "a group has two axes at least, which MC_AddAxisToGroup adds",
    "the axis is in a group, or another axis is in that place of this one",
    "an axis has another unit than its place in the group: the group's at IdentInGroup 1 to 3, deg "
    "at 4 to 6",
    "an axis is not in the task of its group",
    "an axis of the group is in a motion of its own",
    "an axis of the group has no power or an error, and has left the path",
    "no arc leads through the points, or about the centre, to where it is to end",
    "another command waits already, and the axis keeps one: start it when that is Active, or with "
    "BufferMode MC_Aborting",
    "the axes are not where MC_GroupInterrupt has stopped the group: move it there first",
    "nothing is blended behind a motion that does not end standing, as a velocity, a gear or a "
    "cam: "
    "take BufferMode Buffered or Aborting",
    "the block whose command moves the axis has not been called in a scan of its task: call it in "
    "each scan"};
static_assert(std::size(motion_error_texts) == std::size(motion_error_names));

constexpr std::string_view text_of(MotionError error) {
    return motion_error_texts[static_cast<std::size_t>(error)];
}

/// The same, of sync_limits with the limit and by how much it is short, in the unit of the axis.
std::string text_of(MotionError error, const Shortage& shortage, std::string_view unit);
/// Why a profile is out of range: `needed` is what is due at its beginning or end, `allowed` what
/// it has there.
std::string text_of_profile(const Shortage& shortage, std::string_view unit);

/// How MC_Home homes. `other`: there is no such mode. `signalled`: it was `on_signal`, and the
/// signal has come.
enum class HomingMode : std::int64_t { direct, to_position, on_signal, relative, other, signalled };

/// What MC_SetPosition and MC_Home make of the axis being homed. An MC_Home that leaves it
/// unchanged searches a signal alone: the position stays, too.
enum class Referencing : std::int64_t { unchanged, known, unknown };

/// What aborts a superimposed move by TwinCAT's rules: the motion beneath stands, it has come to
/// its end or has been stopped, or neither (blocks/axis/README.md).
enum class AbortedBy : std::int64_t { standstill, end, neither };

inline constexpr std::string_view aborted_by_names[] = {"by_standstill", "by_end", "by_neither"};

/// What a command asks of its axis, in the axis' unit. Dynamics below 0 are the axis' own.
struct Request {
    Command command = Command::none;
    BufferMode mode = BufferMode::aborting;
    MoveDirection direction = MoveDirection::shortest_way;
    double position = 0;      ///< target or distance [u]
    double period = 0;        ///< of the target [u]; 0: the axis' own; below 0: none (TwinCAT)
    double velocity = -1;     ///< [u/s]
    double end_velocity = 0;  ///< of a continuous move [u/s]
    double acceleration = -1, deceleration = -1, jerk = -1;
    std::int64_t enables_positive = 0, enables_negative = 0;  ///< of MC_Power
    std::int64_t holds = 0;                                   ///< Execute of MC_Stop
    std::int64_t is_enabled = 0;                              ///< Enable of MC_MotionInPosition
    std::int64_t halts = 0;       ///< of MC_Phasing: where the shift can come to rest
    double process_velocity = 0;  ///< above 0: MC_MoveSuperimposed goes by the way of the motion
                                  ///< beneath, as planned for this velocity of it [u/s]
    AbortedBy aborted_by = AbortedBy::standstill;    ///< of one that does
    std::int64_t relative = 0;                       ///< of MC_SetPosition
    Referencing reference = Referencing::unchanged;  ///< of MC_SetPosition, MC_Home
    std::int64_t jogs = 0;                           ///< of MC_MoveVelocity: MC_MoveJog has it
    std::int64_t significance = 0;  ///< of MC_Stop: it takes over from one that has no greater
    CommandRules rules = CommandRules::plcopen;
    std::int64_t parameter = 0;  ///< number, of MC_WriteParameter and MC_WriteBoolParameter
    double parameter_value = 0;  ///< its new value, in its unit; of a BOOL 0 or 1
    HomingMode homing = HomingMode::direct;
    double velocity_factor = 1, acceleration_factor = 1, jerk_factor = 1;  ///< MC_SetOverride
    Coupling coupling;

    bool operator==(const Request&) const = default;
};

/// How far an axis is with a job.
enum class Progress : std::int64_t {
    sent,     ///< not taken up yet
    waiting,  ///< buffered
    active,
    approaching,  ///< StartSync: on the way to where the master is met
    reached,      ///< what it holds from there on: InVelocity, InEndVelocity, InGear, InSync
    done,
    aborted,
    failed,
};

constexpr bool is_end(Progress progress) {
    return progress >= Progress::done;
}

inline constexpr std::int64_t nowhere = -1;

/// The list of the axis that a job is in.
enum class JobPlace : std::int64_t { no_list, inbox, queue };

/// Whom a job is for: each has lists of its own.
enum class JobFor : std::int64_t { axis, group };

/// What is common to jobs for axes and for groups of them. A job is what a command has told its
/// axis, and the axis the command; it stands in the command's memory, and the axis links it into
/// its lists. Of both sides each sees what the other's task has published: `task` and `scan` say
/// when the request was written, `told_by` and `told_in` when `progress` was.
struct JobState {
    JobFor whom = JobFor::axis;
    std::int64_t ticket = 0;                          ///< a number for each start of the command
    std::int64_t task = 0, scan = 0;                  ///< of the request
    std::int64_t previous = nowhere, next = nowhere;  ///< places of jobs in a list of the axis
    JobPlace in = JobPlace::no_list;
    Progress progress = Progress::sent, before = Progress::sent;
    std::int64_t has_reached =
        0;  ///< `progress` has been `reached`, though it may have ended since
    std::int64_t told_by = nowhere, told_in = 0;
    std::int64_t called = 0;                ///< scan of `task` that has called the command last
    MotionError error = MotionError::none;  ///< of `failed`

    /// What becomes of it, by a scan of the task that carries it out.
    void tell(Progress how, MotionError why, std::int64_t by_task, std::int64_t in_scan);
};

/// A job for an axis.
struct Job : JobState {
    Request request;
    Shortage shortage;      ///< of sync_limits, or text_of_profile
    double told_value = 0;  ///< what the axis answers beside the progress
    Ahead ahead;            ///< in the queue
};

/// Jobs in a row, linked by their places in the machine's memory.
struct JobList {
    std::int64_t first = nowhere, last = nowhere;
};

/// Puts a job behind the last one of a list, or takes it out.
void link(const Context& context, JobState& job, JobList& list, JobPlace in);
void unlink(const Context& context, JobState& job, JobList& list);

/// Takes out of an inbox what has been published, in the order of the tasks, and of each in that of
/// sending. Of what is taken out `next` alone leads on.
JobList take_due(const Context& context, JobList& inbox);

}  // namespace lineshaft

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "blocks/axis/axis.hpp"
#include "blocks/group/group_job.hpp"
#include "blocks/group/group_states.hpp"
#include "blocks/path/path.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Axes that move along one path (PLCopen Part 4 v1.0). Command blocks of any task tell it what to
/// do, as they tell an axis; its axes are in its own task. See README.md.
struct AxesGroup {
    static constexpr std::size_t look_ahead = 256;  ///< pieces

    AxisUnit unit = AxisUnit::mm;
    double default_velocity = 100, default_acceleration = 1000, default_jerk = 5e4;

    GroupState state = GroupState::disabled;
    bool error = false;
    MotionError error_id = MotionError::none;
    double distance = 0, velocity = 0, acceleration = 0, jerk = 0;  ///< along the path

    /// A command at work that is no move.
    struct Holder {
        std::int64_t place = nowhere;  ///< of its job, nowhere: none
        std::int64_t ticket = 0;
        GroupCommand command = GroupCommand::none;
        std::int64_t holds = 0;     ///< Execute of MC_GroupStop
        std::int64_t frees = 0;     ///< FreesGroup of MC_GroupInterrupt
        std::int64_t told_end = 0;  ///< it is done, and still holds the group

        bool exists() const { return place != nowhere; }
    };

    /// A path that MC_GroupInterrupt has left, with its moves, for MC_GroupContinue.
    struct Aside {
        std::int64_t exists = 0;
        JobList queue;
        Path path;
        PathVector position{}, end_point{};  ///< where it goes on, and ends
    };

    std::array<std::int64_t, most_path_axes> axes{nowhere, nowhere, nowhere,
                                                  nowhere, nowhere, nowhere};
    JobList inbox, queue;
    Holder holder;       ///< MC_GroupStop, MC_GroupHalt
    Holder interrupter;  ///< MC_GroupInterrupt
    Holder overriding;   ///< the MC_GroupSetOverride whose factor counts
    Holder resetter;     ///< MC_GroupReset, until all stand
    Holder leaver;       ///< MC_UngroupAllAxes, until the group stands
    Path path;
    Aside aside;
    std::array<std::array<PathPiece, look_ahead>, 2> rings{};
    std::int64_t ring_in_use = 0;  ///< of the path; the other one is that of the path aside
    PathFrame frame;               ///< of the product, for moves that are taken up from now on
    PathVector position{};         ///< set-point
    PathVector end_point{};        ///< of the last piece in the path
    PathVector turned{};           ///< of each axis' own position against the one it shows (modulo)
    std::int64_t following = 0;    ///< the axes follow the path
    std::int64_t braking = 0;      ///< to standstill, where the path is given up
    std::int64_t interrupted = 0;  ///< until MC_GroupContinue, or until it is left
    std::int64_t has_power = 0;    ///< MC_GroupPower switches it on, also of axes that join
    std::int64_t task = 0, scan_index = 0, time = 0;  ///< of the scan under way; [ns]
    std::int64_t started = 0;

    static constexpr std::string_view type = "axes_group";
    static constexpr std::string_view doc = "axes that move along one path: see the MC_ blocks";
    static constexpr std::string_view handle = "AXES_GROUP_REF";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
    void shift(std::int64_t by) { time += by; }

    std::string why(const Context&, const NameOf&) const { return std::string(text_of(error_id)); }

    /// A command block puts the job, or the end of its Execute, into the inbox.
    void send(const Context& context, const Scan& now, GroupJob& job);

    /// Where the axes are, by their drives where they have some; 0 where there is none.
    PathVector actual_position(const Context& context) const;
    PathVector actual_velocity(const Context& context) const;
    PathVector set_position(const Context& context) const;

    /// All of its axes are, and there are some.
    bool is_powered(const Context& context) const;

    /// Where coordinates of this kind stand in those of the machine.
    PathFrame frame_of(CoordSystem coordinates) const {
        return coordinates == CoordSystem::product ? frame : PathFrame{};
    }
    bool is_in_path() const { return following != 0 && !path.finished(); }

    std::span<PathPiece> ring() { return rings[static_cast<std::size_t>(ring_in_use)]; }
    std::span<const PathPiece> ring() const { return rings[static_cast<std::size_t>(ring_in_use)]; }

  private:
    // axes_group.cpp: time passes.
    Axis* axis(const Context& context, std::size_t place) const;
    void run(const Context& context, double dt);
    void lead(const Context& context, const PathMotion& motion);
    void look_at_axes(const Context& context);
    void look_at_moves(const Context& context);
    void come_to_stand(const Context& context);
    void release(const Context& context);
    void publish(const MotionState& way);
    bool has_unlaid(const Context& context) const;

    // axes_group_jobs.cpp: commands are taken up, told how far they are, and ended.
    void take(const Context& context, GroupJob& job);
    void take_move(const Context& context, GroupJob& job);
    MotionError administer(const Context& context, GroupJob& job);
    MotionError add_axis(const Context& context, const GroupRequest& request);
    MotionError remove_axis(const Context& context, const GroupRequest& request);
    MotionError enable();
    void disable(const Context& context);
    MotionError set_override(const Context& context, GroupJob& job);
    void set_transform(const GroupRequest& request);
    void switch_power(const Context& context, const GroupRequest& request);
    void begin_interrupt(const Context& context, GroupJob& job);
    MotionError go_on(const Context& context);
    void leave_path(const Context& context);
    MotionError return_to_path(const Context& context);
    void forget_path_aside(const Context& context);
    void hold(const Context& context, GroupJob& job);
    void begin_reset(const Context& context, GroupJob& job);
    void finish_reset(const Context& context);
    void begin_to_ungroup(const Context& context, GroupJob& job);
    void ungroup(const Context& context);
    void brake(const PathLimit& limit = no_path_limit);
    void fail(const Context& context, MotionError why);
    void abort_all(const Context& context, Progress how, MotionError why = MotionError::none);
    void end(const Context& context, Holder& ended, Progress how,
             MotionError why = MotionError::none);
    void tell(const Context& context, const Holder& told, Progress how,
              MotionError why = MotionError::none) const;
    void tell(GroupJob& job, Progress how, MotionError why = MotionError::none) const;
    MotionError refusal() const;
    std::size_t axis_count() const;

    // axes_group_tables.cpp: as far as there is room, row by row.
    MotionError lay_table(const Context& context, GroupJob& job);
    MotionError look_through(const Context& context, const GroupJob& job) const;
    bool goes_on(const GroupJob& job) const;
    PathCurve last_curve(const GroupJob& job) const;

    // axes_group_moves.cpp: moves are put into the path.
    void lay(const Context& context);
    MotionError lay(const Context& context, GroupJob& job);
    MotionError check(const Context& context, const GroupRequest& request,
                      const PathFrame& of) const;
    void find_axes(const Context& context);
    MotionError begin_to_follow(const Context& context);
    PathLimits limits_of(const Context& context, const GroupRequest& request) const;
    MotionError stays_inside(const Context& context, const PathCurve& curve) const;
    PathJoint joint_of(const GroupRequest& request, bool is_within, const PathCurve& curve,
                       const PathLimits& limits) const;
    MotionError append(const Context& context, const GroupRequest& request, const PathCurve& curve,
                       bool is_within);
    bool has_room(std::size_t pieces) const {
        return path.count - path.first + pieces + 1 <= look_ahead;
    }
};

/// What a move is refused with.
MotionError motion_error_of(PathFault fault);

}  // namespace lineshaft

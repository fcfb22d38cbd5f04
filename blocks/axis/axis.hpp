#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "blocks/axis/axis_motion.hpp"
#include "blocks/axis/axis_states.hpp"
#include "blocks/axis/axis_unit.hpp"
#include "blocks/axis/job.hpp"
#include "blocks/axis/profile_motion.hpp"
#include "blocks/axis/sync_motion.hpp"
#include "blocks/axis/way.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// A technology object: it owns its motion, and command blocks of any task tell it what to do
/// (PLCopen Part 1 v2.0; blocks/motion/). See README.md for the way of a command.
///
/// Each motion begins in the state in which the one before ends, at that moment, which may lie
/// between two scans, and is a closed form from there on: positions do not drift. The position
/// of a modulo axis is shown in 0..period.
///
/// One struct, though large, as a block is one piece of memory: a file a matter (README.md).
struct Axis {
    /// A job at work: a copy of what its command asked, who reads how far it is.
    struct Running {
        std::int64_t place = nowhere;  ///< of the Job, nowhere: none
        std::int64_t ticket = 0;
        Request request;
        std::int64_t told_end = 0;  ///< its end has been told; it still holds the axis (MC_Stop)
        double from = 0;            ///< of `added` and `phased`: `extra` or shift when it began,
        double covered = 0;         ///< and how far that has come since

        bool exists() const { return place != nowhere; }
    };
    /// What MC_SetOverride makes of velocities, accelerations both ways, and jerks.
    struct Factors {
        double velocity = 1, acceleration = 1, jerk = 1;
    };
    /// What the set-point does.
    enum class Doing : std::int64_t {
        holding,
        moving_to_point,
        following_velocity,
        following_axes,
        following_profile,
        following_group,
        following_set_points,
    };

    /// The way that is left behind the end of `point_motion`, of the same job.
    struct Leg {
        std::int64_t exists = 0;
        double goal = 0, velocity = 0;
        Dynamics dynamics;
        double passed = 0;  ///< where the job ends, on the way to the goal
    };

    /// What is left of a stretch (Ahead) when a move on it ends.
    struct Stretch {
        PointMotion motion;
        Leg leg;
    };

    /// The set-point that was shown last, as long as software limits count.
    struct Shown {
        std::int64_t exists = 0;
        MotionState state;
        std::int64_t time = 0;  ///< [ns]
        double relocated = 0;   ///< of the axis then
    };

    /// What is known to keep the axis inside its software limits, until a motion or a parameter
    /// changes: where the motions under way lead, and states from which it can brake anyway.
    struct Safe {
        std::int64_t as_planned = 0;
        double lowest = 0, highest = -1;     ///< positions between which,
        double speed = 0, acceleration = 0;  ///< with at most these, it can brake

        bool contains(const MotionState& at) const;
    };

    // What each scan touches, side by side: the caches hold no more of thousands of axes. First the
    // set-point, then what may happen to it, at last the motions.
    double position = 0, velocity = 0, acceleration = 0, jerk = 0;
    bool error = false, homed = false;
    bool modulo = false, software_limits = false, has_drive = false;  ///< parameters
    bool is_counted = false;   ///< its masters count it among their followers
    bool wants_calls = false;  ///< by the rules of what it has begun last
    Doing doing = Doing::holding;
    MotionState base;   ///< of the motion beneath, without what is added (README.md)
    double offset = 0;  ///< what the position is further than `base` and `extra`
    MotionState extra;  ///< of what is added on top; while nothing is, at rest at added_goal
    std::int64_t task = 0, scan_index = 0;  ///< of the scan under way, to stamp what is told
    std::int64_t scan_time = 0, scan_interval = 0;  ///< [ns]
    std::int64_t started = 0;
    std::int64_t withdrawn = 0;  ///< a job has left the queue that `active` may count on
    std::int64_t enables_positive = 1, enables_negative = 1;  ///< directions, by MC_Power
    JobList inbox, queue;
    Shown shown;
    Running added;  ///< MC_MoveSuperimposed, on top of the axis' motion
    PointMotion point_motion;
    VelocityMotion velocity_motion;

    // Parameters but for those above.
    AxisUnit unit = AxisUnit::mm;
    AxisProfile profile = AxisProfile::plcopen;
    double period = 0, lowest_position = 0, highest_position = 0;
    double turns = 0;  ///< of a modulo axis: whole periods that `position` leaves out
    double default_velocity = 100, default_acceleration = 1000, default_deceleration = 1000,
           default_jerk = 5e4;
    double start_position = 0;
    double transition_quantum = 0;
    bool needs_power = false, needs_homing = false;

    double actual_position = 0;

    AxisState state = AxisState::standstill;
    MotionError error_id = MotionError::none;

    Running active;      ///< on the axis' motion
    Running overriding;  ///< the MC_SetOverride whose factors count
    Running phased;      ///< MC_Phasing, on the master as the axis sees it
    SyncMotion sync;
    ProfileMotion profile_motion;
    Leg leg;
    PointMotion added_motion;        ///< of `extra`
    double added_goal = 0;           ///< where `extra` ends, once no override of 0 holds it
    double added_before = 0;         ///< way from on top that `base` has taken in since an abort
    std::int64_t added_paused = 0;   ///< on the way there, by an override of 0
    std::int64_t added_counted = 0;  ///< the target of `active` counts on all of `added`
    double added_passed = 0;  ///< of one that goes by way: so much of its plan [s], while the
    double added_seen = 0, added_beneath = 0;  ///< motion beneath was there, with this velocity
    double relocated = 0;        ///< by MC_SetPosition and MC_Home: followers do not see it
    double position_offset = 0;  ///< by MC_SetPosition since the last of MC_Home
    double goal = 0;             ///< of `active`, as a position beneath; where it ended
    double origin = 0;           ///< from where the distance of `active` counts, likewise
    double lasting = 0;          ///< velocity that the motion goes on with, but for the override
    Factors factors;             ///< of MC_SetOverride
    std::int64_t paused = 0;     ///< on the way to `goal`, by an override of 0
    std::int64_t powered = 1, switched = 0;  ///< what MC_Power wants; whether it has said so
    CommandRules switched_by = CommandRules::plcopen;  ///< whose MC_Power
    std::int64_t powered_in = nowhere;  ///< scan in which it got power: what that takes up was
                                        ///< sent without it
    Shortage shortage;                  ///< of the last sync_limits
    double actual_velocity = 0, last_actual = 0;  ///< of the drive
    std::int64_t renamed = 0;                     ///< times that the place got another position
    std::int64_t trigger_aborts = 0;
    std::int64_t commands = 0;   ///< that it has begun
    std::int64_t stopped = 0;    ///< 1: the last of them stops it, or MC_Power has
    std::int64_t followers = 0;  ///< axes that follow it
    std::int64_t counted = nowhere, counted_second = nowhere;  ///< those, with is_counted
    Safe safe;
    std::int64_t group = nowhere;  ///< place of the group (blocks/group/) that it is in
    std::int64_t led_at = 0;       ///< when its group, or a command, moved it last [ns]

    static constexpr std::string_view type = "axis";
    static constexpr std::string_view doc = "axis that takes commands: see the MC_ blocks";
    static constexpr std::string_view handle = "AXIS_REF";
    static const std::string_view structured_text;
    static bool sets_parameter(const Field& field);  ///< by MC_WriteParameter
    static std::span<const Field> fields();
    std::optional<Misfit> misfit(const IsConstant& is_constant) const;
    void scan(const Scan& now, const Context& context);
    void shift(std::int64_t by);
    /// After the power was gone: where it was, at rest, with nothing to do.
    void wake_up(std::int64_t now);
    std::string why(const Context&, const NameOf&) const {
        return text_of(error_id, shortage, axis_unit_names[static_cast<std::size_t>(unit)]);
    }

    /// A command's job, or its changed request, is put into the inbox. Before that the command
    /// writes the request and, at each start, the next ticket.
    void send(const Context& context, const Scan& now, Job& job);

    /// MC_Power does not enable in its first scan: an axis that nothing has switched yet has no
    /// power from the start, for all that look at it later in this scan of its task.
    void begin_without_power(const Context& context);

    Dynamics defaults() const;
    /// What a request says, with the defaults where it is below 0.
    Dynamics asked_of(const Request& request) const;
    /// The same with the override, where that counts.
    Dynamics dynamics_of(const Request& request) const;

    /// A parameter by PLCopen's number, in the unit of the axis; empty for one that it has not.
    std::optional<double> read_parameter(std::int64_t number) const;

    /// Number of the next axis on the way from this one to one that it follows, over however many
    /// others; `nowhere` when it does not.
    std::int64_t way_to(const Context& context, const Axis& leader) const;
    /// The same if it were coupled so.
    std::int64_t way_to(const Context& context, const Axis& leader, const Coupling& coupling) const;

    /// Position and velocity of the drive where there is one, else of the set-point.
    MotionState actual() const;
    MotionState total() const;  ///< as it is shown, but for the modulo

    // axis_in_group.cpp: what a group makes of it.

    /// Why it cannot follow its group from now on: it does not stand, or may not move.
    MotionError cannot_follow() const;
    void begin_to_follow(const Moment& at);
    bool follows_group() const { return doing == Doing::following_group; }
    /// Nothing is known of what comes next.
    bool is_led() const { return follows_group() || doing == Doing::following_set_points; }
    /// The set-point of its group at the scan under way. It is shown then, wherever the axis stands
    /// in the order of its task.
    void follow_group(const MotionState& set_point, const Moment& at);
    /// The path is over, or given up: what is in motion then brakes in ErrorStop.
    void end_following(const Context& context, const Moment& at);
    /// Ends an error that is over; false while the axis still brakes.
    bool reset_by_group();
    /// MC_GroupPower, as MC_Power in both directions.
    void switch_power_by_group(const Context& context, const Moment& at, bool on);
    /// Whether the software limits hold these positions, and MC_Power the directions.
    MotionError cannot_run(double from, double to, double least, double greatest) const;
    bool may_go(double way) const;

  private:
    /// Where a motion beneath begins.
    struct Start {
        MotionState state;
        double origin = 0;         ///< of distances
        double taken = 0;          ///< way of `extra` that is in both, and no longer on top
        bool drops_added = false;  ///< what is on top does not go on
    };
    Start start_of(const Request& request, bool drops_added) const;
    Start start_again() const;
    bool is_overridden() const;
    Dynamics dynamics_with(const Request& request, const Factors& by) const;

    // axis.cpp: time passes.
    void start(const Scan& now);
    void wait_for_power();
    void advance(const Context& context, std::int64_t now);
    bool goes_on(std::int64_t now);
    bool has_ended(std::int64_t now) const;
    void look(const Context& context, std::int64_t now);
    std::pair<MotionState, Moment> end_of_motion(const Context& context) const;
    Cam profile_table(const Context& context) const;
    void end_motion(const Context& context);
    bool is_held() const;
    void end_done(const Context& context);
    void end_stop(const Context& context, const Moment& at);
    void end_hold(const Context& context, const Moment& at);
    void end_leg(const Moment& at);
    void watch_drive(const Context& context, const Scan& now);
    void call_place(double place);
    void publish();

    // axis_limits.cpp: the position stays within software limits.
    struct Bounds {
        double lowest = 0, highest = 0;
        double below = 0, above = 0;  ///< tolerances

        bool contain(const Range& positions) const;
        /// False for a place outside; one within the tolerance is put onto its limit.
        bool admit(double& place) const;
    };
    Bounds bounds() const;
    void watch_limits();
    void keep_limits(const Context& context);
    void show();
    bool is_safe(const MotionState& next);
    bool finds_room(const MotionState& next);
    bool can_brake(const MotionState& from) const;
    bool leads_inside(const Way& way, const Range& further) const;
    Range added_range() const;
    template <class Motion>
    bool leads_inside(const Motion& beneath, const Start& from) const;
    bool goes_on_inside() const;
    bool turns_inside(const MotionState& from) const;
    void stop_inside(const Context& context, MotionError why);
    void stop_at_limit(const Moment& at);
    bool may_aim_at(double& to, const Start& from) const;
    bool may_begin(const PointMotion& next, const Start& from) const;
    bool may_begin(const VelocityMotion& next, const Start& from) const;
    bool may_follow(const ProfileMotion& next, const Cam& cam, const Start& from) const;
    bool may_add(const PointMotion& next, bool by_way) const;
    bool may_wait(const Context& context, const Request& request) const;

    // axis_masters.cpp: what is seen of other axes.
    std::int64_t way_to(const Context& context, const Axis& leader, const Coupling& coupling,
                        int& links_left) const;
    MotionState led_by(const Context& context, const MasterLink& link) const;
    MotionState master(const Context& context) const;
    bool admits(const MasterLink& link) const;
    MotionError check_masters(const Context& context, const Coupling& c) const;
    bool is_steady(const Context& context) const;
    MotionState planned(double t) const;
    Forecast foresee(const Context& context) const;

    // axis_sync.cpp: how other axes begin to be followed.
    MotionError plan_sync(const Context& context, const Request& request, const Moment& at,
                          const Start& from);
    MotionError get_onto_guide(const Context& context, const Moment& at, const MotionState& from);
    MotionError ramp_in(const MotionState& from, const MotionState& leader, const Cam& table,
                        const Moment& at);
    MotionError approach(const Context& context, const MotionState& from, const Cam& table,
                         const Moment& at);
    MotionError lacks(const MotionState& guide, PlanResult result);
    bool plans_in_steps() const;
    MotionError join_law(const Context& context, const Moment& at, const MotionState& from);
    MotionError place_cam(const Context& context, const MotionState& leader,
                          const MotionState& from);
    void place_direct_cam(const MotionState& leader, const MotionState& from, const Cam& table);
    MotionError turn_to_master(const Context& context, const MotionState& leader, const Cam& table);
    Cam cam(const Context& context) const;
    bool may_exchange_cam(const Request& request) const;
    bool exchange_cam(const Context& context, const Request& request);
    Cam begun_anew(Cam table) const;
    void begin_phasing(const Context& context, Job& job);

    // axis_following.cpp: they are followed.
    void count_masters(const Context& context);
    bool follows_itself(const Context& context) const;
    void look_at_shift(const Context& context);
    void follow(const Context& context);
    void follow_guide(const Context& context);
    bool follow_steps(const Context& context, const MotionState& guide);
    bool keeps_gear(const Context& context) const;
    bool is_matched(const MotionState& slave, const MotionState& guide) const;
    void follow_law(const Context& context);
    bool gets_onto(const Context& context, const MotionState& guide);
    bool leaves(const Context& context, const MotionState& leader, const Cam& table);
    void follow_approach(const Context& context, const MotionState& leader, const Cam& table);
    void follow_in_sync(const Context& context, const MotionState& leader, const Cam& table);
    void fail_before(const Context& context, MotionError why);
    void look_for_end(const Context& context, const MotionState& leader, const Cam& table);
    void end_cam(const Context& context, const MotionState& leader, double x,
                 const CurvePoint& point);
    void reach(const Context& context);

    // axis_jobs.cpp: commands are taken up, told how far they are, and ended.
    void take_up(const Context& context, const Scan& now);
    void take(const Context& context, const Moment& at, Job& job);
    void carry_out(const Context& context, const Moment& at, Job& job);
    void change(const Context& context, const Moment& at, Running& running, Job& job);
    void let_go(const Context& context, const Moment& at, Job& job);
    Progress begun() const;
    bool is_endless() const;
    void wait(const Context& context, const Moment& at, Job& job);
    void begin(const Context& context, const Moment& at, Job& job, const Stretch* along = nullptr);
    void begin_next(const Context& context, const Moment& at, const Stretch* rest = nullptr);
    void abort_all(const Context& context, MotionError why = MotionError::none);
    void abort_beneath(const Context& context, Progress how, MotionError why = MotionError::none);
    void end_waiting(const Context& context, Progress how, MotionError why = MotionError::none);
    void end(const Context& context, Running& running, Progress how,
             MotionError why = MotionError::none);
    void tell(const Context& context, const Running& running, Progress how,
              MotionError why = MotionError::none) const;
    void tell(Job& job, Progress how, MotionError why = MotionError::none) const;
    Job& front(const Context& context) const;
    void settle();
    MotionError refusal() const;

    // axis_superimposed.cpp: what comes on top.
    void begin_added(const Context& context, const Moment& at, Job& job);
    void change_added(const Context& context, const Moment& at, const Request& before);
    void replan_added(const Context& context, const Moment& at);
    MotionError plan_added(const Context& context, const Moment& at, const Request& request,
                           double covered, double to);
    void make_up_for(double missing);
    void take_in(double way);
    void look_at_added(std::int64_t now);
    bool goes_by_way() const;
    bool halts_beneath() const;
    double beneath() const;
    MotionState added_by_way() const;
    MotionState added_over_time(double process_velocity) const;
    void watch_beneath(const Context& context);
    void stop_added(const Context& context);
    bool keeps_added(const Request& request) const;
    void end_added(const Context& context);
    void clear_added();

    // axis_commands.cpp: what is done at once.
    MotionError administer(const Context& context, const Moment& at, const Request& request);
    MotionError set_position(const Context& context, const Moment& at, const Request& request);
    MotionError set_override(const Context& context, const Moment& at, const Request& request);
    MotionError write_parameter(const Context& context, std::int64_t number, double value);
    double* limit_of(std::int64_t number);
    void switch_power(const Context& context, const Moment& at, const Request& request);
    bool is_at_work() const;
    void keep_directions(const Context& context);
    void watch_calls(const Context& context);
    void come_to_rest(const Context& context);
    void stop_again(const Context& context, const Moment& at, Job& job);
    bool takes_over_stop(const Request& request) const;
    bool is_occupied() const;
    void release(const Context& context, const Moment& at);
    void leave_error();
    void fail(const Context& context, const Moment& at, MotionError why);
    void brake(const Moment& at);
    void come_to_stand(const Moment& at);
    void hold(const MotionState& as, const Moment& at);

    // axis_plans.cpp: what each command plans.
    MotionError plan_any(const Context& context, const Request& request, const Moment& at,
                         const Start& from);
    MotionError plan_profile(const Context& context, const Request& request, const Moment& at,
                             const Start& from);
    MotionError plan(const Request& request, const Moment& at, Start from);
    MotionError plan_velocity(const Request& request, const Moment& at, const Start& from);
    MotionError plan_point(const Request& request, double to, const Moment& at, const Start& from);
    MotionError go_to(double to, double end_velocity, const Dynamics& d, const Moment& at,
                      const Start& from);
    MotionError go_on(double with, const Dynamics& d, const Moment& at, const Start& from,
                      bool in_any_case = false);
    MotionError plan_homing(const Request& request, const Moment& at, Start& from);
    Dynamics to_stand(const Dynamics& d, const MotionState& from) const;
    bool stands_sooner(const Dynamics& d, const Moment& at, const Start& from) const;
    void replan(const Context& context, const Moment& at);

    // axis_targets.cpp: where a command leads.
    double target_of(const Request& request, const Start& from) const;
    double place_of(const Request& request, const Start& from) const;
    double modulo_target(const Request& request, const Start& from, double turn) const;
    static double nearest_to(double place, double shown_there, double turn);

    // axis_set_points.cpp: the program says in each scan where the axis is.
    MotionState set_point_of(const Request& request, double here) const;
    MotionError plan_set_point(const Request& request, const Moment& at, const Start& from);
    void take_set_point(const MotionState& next, const Moment& at);
    void change_set_point(const Context& context, const Moment& at, const Request& request);
    void end_set_points(const Context& context, const Moment& at);
    void go_on_from_set_point(std::int64_t now);

    // axis_blending.cpp: from one move into the next.
    struct Before {
        const Request& request;
        double end = 0, direction = 0;
    };
    struct Junction;
    void foresee_way(const Request& request, double start, double direction, Ahead& to) const;
    void foresee_speeds(const Request& request, const Request& before, double start,
                        double direction, const Ahead* behind, Ahead& to) const;
    Before before(const Context& context, const Job& job) const;
    bool may_blend(const Context& context, const Request& request) const;
    bool look_back(const Context& context, Job& job) const;
    void look_ahead(const Context& context);
    bool look_ahead(const Context& context, Job& last);
    void blend(const Context& context, const Moment& at);
    void blend_anew(const Context& context, const Moment& at);
    bool leads_along(const Stretch& stretch, const Job& next) const;
    void go_along(const Stretch& stretch, const Job& next, const Start& from);
    std::optional<Speeds> brakeable(const Speeds& exit, const Junction& junction) const;
    bool plan_to_junction(const Junction& junction, double end_velocity, PointMotion& motion,
                          Leg& rest, const Moment& at) const;
};

/// As of any block; of many axes what the next ones' scans touch is on its way from memory
/// meanwhile.
template <>
bool Catalog::scan_blocks<Axis>(std::byte* first, std::size_t count, const Scan& now,
                                const Context& context);

/// Whether PLCopen's parameter of that number is a BOOL: software limits on or off.
bool is_bool_parameter(std::int64_t number);

/// Whether the axis does it at once, whatever it is doing.
bool is_administrative(Command command);

/// Whether it moves to a position, wherever it begins.
bool is_absolute(Command command);

/// Whether it goes on from a position with a velocity.
bool is_continuous(Command command);

/// Whether it acts on what is on top of the motion.
bool is_superimposed(Command command);

/// Whether the target of a move is further by what has come on top, by its vendor's rules.
bool keeps_superimposed(const Request& request);

/// Whether the axis follows others by it; whether it shifts the master that the axis follows.
bool is_synchronous(Command command);
bool is_phasing(Command command);

/// Whether an axis takes it up while its group moves it. By what moves the axis it leaves the path.
bool is_taken_in_group(const Request& request);

/// Whether a table gives the motion over time.
bool is_profile(Command command);

/// Whether it asks for turns on the shortest way to a position, which has none.
bool adds_turns_to_shortest(const Request& request);

MotionError motion_error_of(PlanResult result);

/// From 0 up to `period`; the position itself without a period.
double within_period(double position, double period);

}  // namespace lineshaft

#include "blocks/axis/axis.hpp"

#include <cmath>

#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t axes_ahead = 4;

constexpr std::string_view doing_names[] = {
    "holding",           "moving_to_point", "following_velocity",  "following_axes",
    "following_profile", "following_group", "following_set_points"};

/// The phase of a plan is known once the line is there that says which: it is a nearer axis'.
void prefetch(const Axis* axis) {
    const auto ask_for = [](const void* from, const void* to) {
        constexpr std::ptrdiff_t line = 64;
        for (auto at = static_cast<const char*>(from); at < to; at += line) __builtin_prefetch(at);
    };
    const Axis& far = axis[axes_ahead];
    ask_for(&far, &far.added.ticket);
    ask_for(&far.point_motion, &far.point_motion.plan.end);
    const PointMotion& near = axis[axes_ahead / 2].point_motion;
    const MotionPlan::Phase* const phase = near.plan.phases.data() + near.phase;
    ask_for(phase, phase + 1);
}

Field of_sync(Field of_motion) {
    of_motion.offset += detail::offset_of(&Axis::sync);
    return of_motion;
}

/// A field of the gear to its master.
Field of_gear(Field of_coupling) {
    of_coupling.offset += detail::offset_of(&SyncMotion::coupling);
    return of_sync(of_coupling);
}

/// A field of the request at work.
Field of_active(Field of_running) {
    of_running.offset += detail::offset_of(&Axis::active);
    return of_running;
}

}  // namespace

template <>
bool Catalog::scan_blocks<Axis>(std::byte* first, std::size_t count, const Scan& now,
                                const Context& context) {
    constexpr std::size_t in_cache = 100;
    bool error = false;
    Axis* axis = std::launder(reinterpret_cast<Axis*>(first));
    for (; count > 0; --count, ++axis) {
        if (count > in_cache) prefetch(axis);
        axis->scan(now, context);
        error |= axis->error;
    }
    return error;
}

std::span<const Field> Axis::fields() {
    using A = Axis;
    static const Field table[] = {
        parameter("unit", &A::unit, "", "unit of the axis").one_of(axis_unit_names),
        parameter("profile", &A::profile, "", "whose rules count where vendors differ")
            .one_of(axis_profile_names),
        parameter("modulo", &A::modulo, "", "the position is shown in 0..`period`"),
        parameter("period", &A::period, "{unit}", "of a modulo axis").at_least(0),
        parameter("default_velocity", &A::default_velocity, "{unit}/s",
                  "of commands with a velocity below 0")
            .above(0),
        parameter("default_acceleration", &A::default_acceleration, "{unit}/s^2",
                  "of commands with an acceleration below 0")
            .above(0),
        parameter("default_deceleration", &A::default_deceleration, "{unit}/s^2",
                  "of commands with a deceleration below 0, and of the axis when it must stop; in "
                  "front of a software limit it stops harder where that is too weak")
            .above(0),
        parameter("default_jerk", &A::default_jerk, "{unit}/s^3",
                  "of commands with a jerk below 0; 0: trapezoids, whose acceleration comes in a "
                  "nanosecond")
            .at_least(0),
        parameter(
            "software_limits", &A::software_limits, "",
            "the position stays in `lowest_position`..`highest_position`; an axis that was put "
            "outside only comes in"),
        parameter("lowest_position", &A::lowest_position, "{unit}", "with `software_limits`"),
        parameter("highest_position", &A::highest_position, "{unit}", "with `software_limits`"),
        parameter("start_position", &A::start_position, "{unit}", "position at the first scan"),
        parameter("needs_power", &A::needs_power, "",
                  "disabled until MC_Power gives it power; else an axis has power that no MC_Power "
                  "has switched off"),
        parameter("needs_homing", &A::needs_homing, "",
                  "Siemens' MC_MOVEABSOLUTE is an error until MC_HOME has made the position known; "
                  "else the encoder knows it from the beginning"),
        parameter(
            "transition_quantum", &A::transition_quantum, "s",
            "a slave gets into gear in whole steps of this, from the start of its job, each at "
            "one acceleration, as an interpolator that plans more coarsely than the motion "
            "clock; 0: exactly")
            .at_least(0),
        parameter("has_drive", &A::has_drive, "",
                  "`actual_position` comes from a drive; else it is the set-point"),
        input("actual_position", &A::actual_position, "{unit}", "with `has_drive`"),
        output("position", &A::position, "{unit}", "set-point"),
        output("velocity", &A::velocity, "{unit}/s", "of the set-point"),
        output("acceleration", &A::acceleration, "{unit}/s^2", "of the set-point"),
        output("jerk", &A::jerk, "{unit}/s^3", "of the set-point"),
        output("state", &A::state, "", "of PLCopen").one_of(axis_state_names),
        output("error", &A::error, "", "the axis has stopped; MC_Reset ends it"),
        output("error_id", &A::error_id, "", "why").one_of(motion_error_names),
        local("actual_velocity", &A::actual_velocity, "{unit}/s", "with `has_drive`"),
        local("turns", &A::turns, "", "of a modulo axis: whole periods that `position` leaves out"),
        local("homed", &A::homed, "", "by MC_Home"),
        local("doing", &A::doing, "", "what the set-point does").one_of(doing_names),
        local("powered", &A::powered, "", "1: as MC_Power wants it"),
        local("enables_positive", &A::enables_positive, "", "1: the direction, by MC_Power"),
        local("enables_negative", &A::enables_negative, "", "likewise"),
        local("position_offset", &A::position_offset, "{unit}",
              "that MC_SetPosition has added since MC_Home"),
        of_active(local("jogs", &A::Running::request, &Request::jogs, "",
                        "1: what moves it is MC_MoveJog")),
        of_active(local("asked_deceleration", &A::Running::request, &Request::deceleration,
                        "{unit}/s^2", "of the command under way; below 0: the axis' own")),
        of_active(local("asked_jerk", &A::Running::request, &Request::jerk, "{unit}/s^3",
                        "likewise; 0: without a limit")),
        local("superimposed", &A::added, &A::Running::place, "",
              "which command adds a distance; below 0: none"),
        local("velocity_factor", &A::factors, &A::Factors::velocity, "", "of MC_SetOverride"),
        local("acceleration_factor", &A::factors, &A::Factors::acceleration, "", "likewise"),
        local("jerk_factor", &A::factors, &A::Factors::jerk, "", "likewise"),
        local("synchronization", &A::sync, &SyncMotion::stage, "", "in synchronized_motion")
            .one_of(SyncMotion::stage_names),
        of_gear(local("gear_numerator", &Coupling::master, &MasterLink::numerator, "",
                      "of the ratio to the axis that it follows")),
        of_gear(
            local("gear_denominator", &Coupling::master, &MasterLink::denominator, "", "likewise")),
        of_sync(local("phase_shift", &SyncMotion::shift, &MotionState::position, "",
                      "of the axis that it follows, as it sees it")),
        local("phasing", &A::phased, &A::Running::place, "", "below 0: that does not move"),
        local("followers", &A::followers, "", "axes that follow it"),
        local("commands", &A::commands, "", "that it has begun"),
        local(
            "stopped", &A::stopped, "",
            "1: what it has begun last is MC_Stop, MC_Halt or the end of a jog, or it has come to "
            "a direction that MC_Power of TwinCAT does not enable"),
        local("waiting", &A::queue, &JobList::first, "", "below 0: no command waits"),
        local("base_velocity", &A::base, &MotionState::velocity, "{unit}/s",
              "of the motion without what is on top"),
        local("goal", &A::goal, "{unit}", "of the move at work, without what is on top"),
        local("added_goal", &A::added_goal, "{unit}", "what is on top then"),
    };
    return table;
}

std::optional<Misfit> Axis::misfit(const IsConstant&) const {
    if (modulo && !(period > 0))
        return Misfit{"modulo", "a modulo axis needs its 'period', as 360 deg"};
    if (software_limits && !(lowest_position < highest_position))
        return Misfit{"software_limits", "'lowest_position' is not below 'highest_position'"};
    if (software_limits && modulo)
        return Misfit{"software_limits", "a modulo axis turns without end: it has no limits"};
    return {};
}

double within_period(double position, double period) {
    if (!(period > 0)) return position;
    const double rest = std::fmod(position, period);
    return rest < 0 ? (rest + period < period ? rest + period : 0) : rest + 0.0;  // not -0
}

void Axis::scan(const Scan& now, const Context& context) {
    if (started == 0) start(now);
    watch_limits();
    if (withdrawn != 0 || inbox.first != nowhere) safe = {};
    if (withdrawn != 0) blend_anew(context, {scan_time});
    task = context.task;
    scan_index = now.index;
    scan_time = now.time;
    scan_interval = now.interval;
    advance(context, now.time);
    if (has_drive) watch_drive(context, now);
    if (inbox.first != nowhere) {
        take_up(context, now);
        advance(context, now.time);
    }
    if (software_limits) keep_limits(context);
    if (enables_positive == 0 || enables_negative == 0) keep_directions(context);
    if (wants_calls) watch_calls(context);
    if (is_counted || doing == Doing::following_axes) count_masters(context);
    publish();
}

void Axis::start(const Scan& now) {
    started = 1;
    goal = start_position;
    hold({.position = start_position}, {now.time});
    base.position = start_position;
    position = modulo ? within_period(start_position, period) : start_position;
    if (needs_power) wait_for_power();
}

void Axis::wait_for_power() {
    powered = 0;
    state = AxisState::disabled;
}

void Axis::wake_up(std::int64_t now) {
    const double place = total().position;
    inbox = queue = {};
    shown = {};
    active = added = phased = overriding = {};
    factors = {};
    sync = {};
    extra = {};
    safe = {};
    offset = lasting = added_goal = added_before = 0;
    withdrawn = added_paused = added_counted = stopped = 0;
    is_counted = wants_calls = false;
    followers = 0;
    counted = counted_second = nowhere;
    powered = enables_positive = enables_negative = 1;
    switched = 0;
    hold({.position = place}, {now});
    goal = origin = place;
    error = false;
    error_id = MotionError::none;
    state = AxisState::standstill;
    velocity = acceleration = jerk = actual_velocity = 0;
    if (needs_power) wait_for_power();
}

void Axis::shift(std::int64_t by) {
    for (Moment* moment : {&velocity_motion.start, &point_motion.start, &added_motion.start,
                           &profile_motion.start, &sync.start, &sync.looked, &sync.shifting.start})
        moment->time += by;
    shown.time += by;
    scan_time += by;
    led_at += by;
}

void Axis::watch_drive(const Context& context, const Scan& now) {
    if (!std::isfinite(actual_position)) return fail(context, {now.time}, MotionError::not_finite);
    if (now.index > 0) actual_velocity = (actual_position - last_actual) / seconds(now.interval);
    last_actual = actual_position;
}

MotionState Axis::actual() const {
    if (!has_drive) return {position, velocity, acceleration, jerk};
    return {modulo ? within_period(actual_position, period) : actual_position, actual_velocity};
}

MotionState Axis::total() const {
    return {base.position + offset + extra.position, base.velocity + extra.velocity,
            base.acceleration + extra.acceleration, base.jerk + extra.jerk};
}

void Axis::advance(const Context& context, std::int64_t now) {
    if (goes_on(now)) return;
    while (has_ended(now)) end_motion(context);
    const bool over_time = added.exists() && added_paused == 0 && !goes_by_way();
    if (over_time && added_motion.has_ended(now)) end_added(context);
    look(context, now);
    if (goes_by_way()) watch_beneath(context);
}

/// What most scans are: a move goes on, with nothing on top of it. False where more than that is
/// to be looked at.
inline bool Axis::goes_on(std::int64_t now) {
    if (doing != Doing::moving_to_point || added.exists()) return false;
    const double t = point_motion.start.until(now);
    if (Moment::is_over(point_motion.duration, t)) return false;
    base = point_motion.later(t);
    return true;
}

bool Axis::has_ended(std::int64_t now) const {
    if (doing == Doing::moving_to_point) return point_motion.has_ended(now);
    if (doing == Doing::following_profile) return profile_motion.has_ended(now);
    return doing == Doing::following_velocity && velocity_motion.has_ended(now);
}

void Axis::look(const Context& context, std::int64_t now) {
    if (doing == Doing::following_group) return;
    if (doing == Doing::following_axes)
        follow(context);
    else if (doing == Doing::following_set_points)
        go_on_from_set_point(now);
    else if (doing == Doing::following_profile)
        base = profile_motion.at(profile_motion.start.until(now), profile_table(context));
    else
        base = doing == Doing::moving_to_point ? point_motion.at(now) : velocity_motion.at(now);
    if (added.exists()) look_at_added(now);
}

std::pair<MotionState, Moment> Axis::end_of_motion(const Context& context) const {
    if (doing == Doing::moving_to_point) return {point_motion.end_state, point_motion.end()};
    if (doing == Doing::following_velocity)
        return {velocity_motion.end_state(), velocity_motion.end()};
    return {profile_motion.end(profile_table(context)),
            profile_motion.start.after(profile_motion.duration)};
}

/// What comes next begins at that very moment; from standstill with the scan that it belongs to.
void Axis::end_motion(const Context& context) {
    safe.as_planned = 0;
    auto [end_state, at] = end_of_motion(context);
    const bool is_cut = doing == Doing::moving_to_point && point_motion.is_cut();
    if (leg.exists != 0 && !is_cut) return end_leg(at);
    const Stretch rest{point_motion, leg};
    const bool goes_on = is_cut && offset == 0 && added_goal == 0;
    if (end_state.velocity == 0 && at.until(scan_time) < 0) at = {scan_time};
    const bool pauses = paused != 0, of_profile = doing == Doing::following_profile;
    hold(end_state, at);
    base = end_state;
    if (of_profile) lasting = end_state.velocity;
    if (added.exists()) look_at_added(at.time);
    paused = pauses ? 1 : 0;
    if (pauses) return;
    if (state == AxisState::error_stop || state == AxisState::disabled)
        return come_to_rest(context);
    if (state == AxisState::stopping) return end_stop(context, at);
    if (!active.exists()) return settle();
    if (of_profile && base.velocity != lasting * factors.velocity) return replan(context, at);
    if (state == AxisState::homing && active.request.homing == HomingMode::on_signal) return;
    if (halts_beneath()) return;
    if (state == AxisState::continuous_motion && active.request.command != Command::gear_out &&
        active.request.command != Command::cam_out)
        tell(context, active, Progress::reached);
    else
        end_done(context);
    if (queue.first != nowhere && !is_held())
        return begin_next(context, at, goes_on ? &rest : nullptr);
    settle();
}

/// By an override of 0, before it could go on: what waits for that goes on waiting.
bool Axis::is_held() const {
    return paused != 0 || (factors.velocity == 0 && lasting != 0);
}

void Axis::end_done(const Context& context) {
    const bool is_found = active.request.reference == Referencing::known;
    homed = homed || (active.request.command == Command::home && is_found);
    end(context, active, Progress::done);
}

/// MC_Stop is done, and goes on to hold the axis while its Execute is true.
void Axis::end_stop(const Context& context, const Moment& at) {
    tell(context, active, Progress::done);
    active.told_end = 1;
    if (active.request.holds == 0) end_hold(context, at);
}

/// What waits for Done AND NOT Execute of MC_Stop begins.
void Axis::end_hold(const Context& context, const Moment& at) {
    active = {};
    begin_next(context, at);
}

void Axis::end_leg(const Moment& at) {
    const Leg next = leg;
    base = point_motion.end_state;
    point_motion.begin(base, next.goal, next.velocity, next.dynamics, at);
    point_motion.end_at(next.passed, next.velocity);
    leg.exists = 0;
}

/// Standing, with nothing to do but for what waits until something moves.
void Axis::settle() {
    const bool adds = added.exists() && !goes_by_way();
    if (active.exists() || adds || doing != Doing::holding) return;
    if (velocity_motion.ramp.end.velocity != 0 || lasting != 0) return;
    if (state != AxisState::disabled && state != AxisState::error_stop)
        state = AxisState::standstill;
}

/// How a place is shown, from which what is still to be done in this scan begins.
void Axis::call_place(double place) {
    position = modulo ? within_period(place, period) : place;
    if (modulo) turns = std::round((place - position) / period);
}

// The four are stored in one go: else gcc loads velocity and acceleration together, which advance()
// has just stored in two pieces, and the processor waits (ten axes in motion take 141 ns, not 150).
void Axis::publish() {
    const MotionState now = software_limits ? shown.state : total();
    if (!all_finite(now.position, now.velocity, now.acceleration, now.jerk)) {
        error = true;
        error_id = MotionError::not_finite;
        return;
    }
    call_place(now.position);
    velocity = now.velocity;
    acceleration = now.acceleration;
    jerk = now.jerk;
}

}  // namespace lineshaft

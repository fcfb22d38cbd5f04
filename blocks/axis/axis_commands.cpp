#include <algorithm>
#include <cassert>
#include <cmath>

#include "blocks/axis/axis.hpp"
#include "blocks/axis/cam_table.hpp"
#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

double sign_of(double x) {
    return x < 0 ? -1 : 1;
}

}  // namespace

MotionError motion_error_of(PlanResult result) {
    if (result == PlanResult::ok) return MotionError::none;
    return result == PlanResult::not_finite ? MotionError::not_finite
                                            : MotionError::limit_not_positive;
}

bool is_administrative(Command command) {
    using enum Command;
    return command == power_on || command == power_off || command == reset ||
           command == set_position || command == set_override || command == write_parameter ||
           command == write_bool_parameter || command == abort_trigger;
}

Dynamics Axis::defaults() const {
    return {default_velocity, default_acceleration, default_deceleration,
            effective_jerk(default_jerk, default_acceleration, default_deceleration)};
}

bool is_absolute(Command command) {
    using enum Command;
    return command == move_absolute || command == move_continuous_absolute || command == home;
}

bool is_continuous(Command command) {
    return command == Command::move_continuous_absolute ||
           command == Command::move_continuous_relative;
}

Dynamics Axis::dynamics_with(const Request& request, const Factors& by) const {
    const auto chosen = [](double asked, double otherwise) {
        return asked < 0 ? otherwise : asked;
    };
    Dynamics d;
    d.velocity = chosen(request.velocity, default_velocity) * by.velocity;
    d.acceleration = chosen(request.acceleration, default_acceleration) * by.acceleration;
    d.deceleration = chosen(request.deceleration, default_deceleration) * by.acceleration;
    d.jerk = effective_jerk(chosen(request.jerk, default_jerk) * by.jerk, d.acceleration,
                            d.deceleration);
    return d;
}

Dynamics Axis::asked_of(const Request& request) const {
    return dynamics_with(request, {});
}

Dynamics Axis::dynamics_of(const Request& request) const {
    const bool of_slave = is_synchronous(request.command) || is_phasing(request.command) ||
                          (is_superimposed(request.command) && !is_overridden());
    return of_slave ? asked_of(request) : dynamics_with(request, factors);
}

/// MC_SetOverride does not act on a slave.
bool Axis::is_overridden() const {
    return state != AxisState::synchronized_motion;
}

// Administrative commands.

MotionError Axis::administer(const Context& context, const Moment& at, const Request& request) {
    switch (request.command) {
        case Command::power_on:
        case Command::power_off:
            switch_power(context, at, request);
            return MotionError::none;
        case Command::reset:
            if (state == AxisState::error_stop) leave_error();
            return MotionError::none;
        case Command::set_position:
            return set_position(context, at, request);
        case Command::set_override:
            return set_override(context, at, request);
        case Command::abort_trigger:
            ++trigger_aborts;
            return MotionError::none;
        case Command::write_bool_parameter:
            if (!is_bool_parameter(request.parameter)) return MotionError::no_such_parameter;
            return write_parameter(context, request.parameter, request.position);
        case Command::write_parameter:
            return write_parameter(context, request.parameter, request.position);
        case Command::none:
        case Command::home:
        case Command::stop:
        case Command::halt:
        case Command::move_absolute:
        case Command::move_relative:
        case Command::move_additive:
        case Command::move_superimposed:
        case Command::halt_superimposed:
        case Command::move_velocity:
        case Command::move_continuous_absolute:
        case Command::move_continuous_relative:
        case Command::position_profile:
        case Command::velocity_profile:
        case Command::acceleration_profile:
        case Command::motion_in_position:
        case Command::gear_in:
        case Command::gear_out:
        case Command::gear_in_pos:
        case Command::cam_in:
        case Command::cam_out:
        case Command::phasing_absolute:
        case Command::phasing_relative:
        case Command::combine_axes:
            break;
    }
    assert(!is_administrative(request.command));
    return MotionError::wrong_state;
}

void Axis::switch_power(const Context& context, const Moment& at, const Request& request) {
    const bool on = request.command == Command::power_on;
    powered = on ? 1 : 0;
    switched = 1;
    enables_positive = request.enables_positive;
    enables_negative = request.enables_negative;
    if (state == AxisState::error_stop) return;
    if (!on) {
        brake(at);
        abort_all(context);
        state = AxisState::disabled;
    } else if (doing == Doing::holding) {
        come_to_rest(context);
    }
}

void Axis::begin_without_power(const Context& context) {
    if (switched != 0 || started == 0 || task != context.task) return;
    if (state == AxisState::standstill) state = AxisState::disabled;
}

/// Whether MC_Power enables the direction of a way, or of a velocity.
bool Axis::may_go(double way) const {
    return way == 0 || (way > 0 ? enables_positive : enables_negative) != 0;
}

/// What goes in a direction that is not enabled brakes, and that is an error: but for what brakes
/// already.
void Axis::keep_directions(const Context& context) {
    constexpr double rounding = 1e-9;
    const double v = total().velocity;
    const bool brakes = doing == Doing::following_velocity && !added.exists() &&
                        velocity_motion.ramp.end.velocity == 0;
    if (may_go(v) || brakes || state == AxisState::disabled) return;
    if (std::abs(v) > rounding * default_velocity)
        fail(context, {scan_time}, MotionError::direction_not_enabled);
}

/// Without power, or with an error: once it stands it may be wanted again.
void Axis::come_to_rest(const Context& context) {
    if (state == AxisState::disabled && powered != 0) state = AxisState::standstill;
    if (state != AxisState::error_stop || queue.first == nowhere) return;
    while (queue.first != nowhere) {
        Job& reset = front(context);
        unlink(context, reset, queue);
        tell(reset, Progress::done);
    }
    leave_error();
}

/// The MC_Stop that holds the axis, begun anew: it goes on to hold it, and stands no later.
void Axis::stop_again(const Context& context, const Moment& at, Job& job) {
    if (doing != Doing::holding) {
        const MotionState from = total();
        VelocityMotion anew;
        const PlanResult planned = anew.begin(from, 0, dynamics_of(job.request), at);
        if (planned != PlanResult::ok) return tell(job, Progress::failed, motion_error_of(planned));
        const double left = velocity_motion.ramp.duration - velocity_motion.start.until(at.time);
        if (anew.ramp.duration < left) {
            velocity_motion = anew;
            base = from;
            offset = 0;
            goal = velocity_motion.end_state().position;
        }
    }
    end_waiting(context, Progress::aborted);
    active = {context.place_of(job), job.ticket, job.request, 0};
    tell(job, Progress::active);
    if (doing == Doing::holding) end_stop(context, at);
}

void Axis::leave_error() {
    error = false;
    error_id = MotionError::none;
    state = powered != 0 ? AxisState::standstill : AxisState::disabled;
}

MotionError Axis::set_position(const Context& context, const Moment& at, const Request& request) {
    const bool relative = request.relative != 0;
    if (modulo && !relative && (request.position < 0 || request.position >= period))
        return MotionError::out_of_range;
    const bool waited = request.mode != BufferMode::aborting;  // for an end since the last scan
    const double end = total().position;
    const double here = !waited ? position : modulo ? within_period(end, period) : end;
    const double by = relative ? request.position : request.position - here;
    ++renamed;
    offset += by;
    relocated += by;
    goal += by;
    origin += by;
    const bool homes = request.homes != 0;
    homed = homed || homes;
    if (homes && active.exists() && active.request.command == Command::move_absolute) {
        goal -= by;
        replan(context, at);
    } else if (queue.first != nowhere) {
        blend_anew(context, at);
    }
    return MotionError::none;
}

MotionError Axis::set_override(const Context& context, const Moment& at, const Request& request) {
    if (!(request.velocity_factor >= 0) || !(request.acceleration_factor > 0) ||
        !(request.jerk_factor > 0))
        return MotionError::out_of_range;
    factors = {request.velocity_factor, request.acceleration_factor, request.jerk_factor};
    replan_added(context, at);
    replan(context, at);
    return MotionError::none;
}

void Axis::fail(const Context& context, const Moment& at, MotionError why) {
    if (state == AxisState::error_stop) return;
    brake(at);
    abort_all(context, why);
    error = true;
    error_id = why;
    state = AxisState::error_stop;
}

// Motions.

void Axis::hold(const MotionState& as, const Moment& at) {
    velocity_motion.hold(as, at);
    doing = Doing::holding;
    leg.exists = paused = 0;
    base = {as.position, as.velocity, 0, 0};
}

void Axis::brake(const Moment& at) {
    const MotionState from = total();
    const Moment since = follows_group() ? Moment{led_at} : at;
    offset = lasting = 0;
    clear_added();
    leg.exists = paused = 0;
    safe.as_planned = 0;
    base = from;
    if (from.velocity == 0 && from.acceleration == 0) return hold(from, at);
    velocity_motion.begin(from, 0, defaults(), since);
    doing = Doing::following_velocity;
}

/// What was to go on from the end of a move does not.
void Axis::come_to_stand(const Moment& at) {
    if (base.velocity == 0 && base.acceleration == 0) return;
    velocity_motion.begin(base, 0, defaults(), at);
    doing = Doing::following_velocity;
}

/// With all the way that is on top: of what it aborts as far as that has come, else to its end.
Axis::Start Axis::start_of(const Request& request, bool keeps_added) const {
    Start from = start_again();
    from.taken = keeps_added ? added_goal : extra.position;
    from.state.position += from.taken;
    from.drops_added = !keeps_added;
    if (!keeps_added) from.state = total();
    const bool from_goal =
        request.command == Command::move_additive && state == AxisState::discrete_motion;
    from.origin = from_goal ? goal + from.taken : from.state.position;
    return from;
}

/// Of `active`, to plan it anew.
Axis::Start Axis::start_again() const {
    Start from{base, origin};
    from.state.position += offset;
    return from;
}

MotionError Axis::plan_any(const Context& context, const Request& request, const Moment& at,
                           const Start& from) {
    shortage = {};
    if (is_synchronous(request.command)) return plan_sync(context, request, at, from);
    if (is_profile(request.command)) return plan_profile(context, request, at, from);
    if (request.command == Command::motion_in_position) return plan_set_point(request, at, from);
    return plan(request, at, from);
}

bool is_profile(Command command) {
    return command == Command::position_profile || command == Command::velocity_profile ||
           command == Command::acceleration_profile;
}

namespace {

ProfileOf profile_of(Command command) {
    return command == Command::position_profile   ? ProfileOf::position
           : command == Command::velocity_profile ? ProfileOf::velocity
                                                  : ProfileOf::acceleration;
}

}  // namespace

Cam Axis::profile_table(const Context& context) const {
    return context.instance<CamTable>(profile_motion.table).cam(false);
}

/// It begins where the axis is, with its velocity, and a profile of positions ends in rest.
MotionError Axis::plan_profile(const Context& context, const Request& request, const Moment& at,
                               const Start& from) {
    const Coupling& c = request.coupling;
    const ProfileOf of = profile_of(request.command);
    const bool of_position = of == ProfileOf::position;
    const CamTableId id = CamTableId::of(c.cam);
    if (id.table < 0) return MotionError::no_cam;
    const CamTable& table = context.instance<CamTable>(id.table);
    if (table.cam(false).points.empty() || !table.is_over_time(unit, of))
        return MotionError::no_cam;
    if (!(c.master_scaling > 0)) return MotionError::out_of_range;
    const Cam cam = table.cam(false);
    ProfileMotion next{at, id.table, of, c.master_scaling, c.slave_scaling, c.slave_offset};
    next.start_position = from.state.position;
    next.start_velocity = from.state.velocity;
    next.duration = cam.length() * c.master_scaling;
    const MotionState begin = next.at(0, cam), end = next.at(next.duration, cam);
    constexpr double nanosecond = 1e-9;
    const Dynamics d = defaults();
    const double v = d.acceleration * nanosecond, a = d.jerk * nanosecond;
    const auto differs = [&](CurveFault what, double has, double due, double most) {
        if (std::abs(has - due) <= most) return false;
        shortage = {what, due, has};
        return true;
    };
    const MotionState& axis = from.state;
    if (differs(CurveFault::none, begin.position, axis.position,
                1e-9 * (1 + std::abs(begin.position))) ||
        differs(CurveFault::velocity, begin.velocity, axis.velocity, v) ||
        differs(CurveFault::acceleration, begin.acceleration, axis.acceleration, a) ||
        differs(CurveFault::acceleration, end.acceleration, 0, a) ||
        (of_position && differs(CurveFault::velocity, end.velocity, 0, v)))
        return MotionError::out_of_range;
    if (!next.keeps(d, cam)) return MotionError::sync_limits;
    if (!may_follow(next, cam, from)) return MotionError::software_limit;
    profile_motion = next;
    doing = Doing::following_profile;
    leg.exists = paused = 0;
    lasting = 0;
    origin = goal = of_position ? next.end(cam).position : from.origin;
    offset = 0;
    base = from.state;
    return MotionError::none;
}

MotionError Axis::plan(const Request& request, const Moment& at, Start from) {
    const Dynamics d = dynamics_of(request);
    if (!(d.acceleration > 0) || !(d.deceleration > 0) || !(d.jerk > 0))
        return MotionError::limit_not_positive;
    using enum Command;
    MotionError why = MotionError::none;
    if (request.command == stop || request.command == halt || request.command == move_velocity ||
        request.command == gear_out || request.command == cam_out) {
        why = plan_velocity(request, at, from);
    } else if (request.command == home) {
        why = plan_homing(request, at, from);
    } else {
        why = plan_point(request, target_of(request, from), at, from);
    }
    if (why != MotionError::none) return why;
    origin = from.origin;
    offset = 0;
    base = from.state;
    return why;
}

MotionError Axis::plan_velocity(const Request& request, const Moment& at, const Start& from) {
    double wanted = 0;
    const MotionState& now = from.state;
    if (request.command == Command::gear_out || request.command == Command::cam_out)
        wanted = now.velocity +
                 now.acceleration * std::abs(now.acceleration) / (2 * dynamics_of(request).jerk);
    if (request.command == Command::move_velocity) {
        wanted = request.velocity;
        if (request.direction == MoveDirection::negative) wanted = -wanted;
        if (request.direction == MoveDirection::current)
            wanted = std::copysign(wanted, sign_of(now.velocity != 0 ? now.velocity : lasting));
        if (!may_go(wanted)) return MotionError::direction_not_enabled;
    }
    return go_on(wanted, dynamics_of(request), at, from, request.command == Command::stop);
}

/// To a velocity and on with it, both with the override; in any case, or where limits allow.
MotionError Axis::go_on(double with, const Dynamics& d, const Moment& at, const Start& from,
                        bool in_any_case) {
    VelocityMotion next;
    const MotionError why = motion_error_of(next.begin(from.state, with * factors.velocity, d, at));
    if (why != MotionError::none) return why;
    if (!in_any_case && !may_begin(next, from)) return MotionError::software_limit;
    velocity_motion = next;
    doing = Doing::following_velocity;
    leg.exists = paused = 0;
    lasting = with;
    goal = velocity_motion.end_state().position;
    return why;
}

MotionError Axis::plan_point(const Request& request, double to, const Moment& at,
                             const Start& from) {
    if (!asked_of(request).valid()) return MotionError::limit_not_positive;
    if (adds_turns_to_shortest(request)) return MotionError::out_of_range;
    if (!may_aim_at(to, from)) return MotionError::software_limit;
    const double direction = sign_of(to - from.state.position);
    const double end_velocity =
        is_continuous(request.command) ? direction * request.end_velocity : 0;
    if (!may_go(to - from.state.position) || !may_go(end_velocity))
        return MotionError::direction_not_enabled;
    return go_to(to, end_velocity, dynamics_of(request), at, from);
}

/// To a position and on with a velocity, with the override.
MotionError Axis::go_to(double to, double end_velocity, const Dynamics& d, const Moment& at,
                        const Start& from) {
    const bool pauses = factors.velocity == 0;
    VelocityMotion stop;
    PointMotion next;
    const MotionError why = motion_error_of(
        pauses ? stop.begin(from.state, 0, d, at)
               : next.begin(from.state, to, end_velocity * factors.velocity, d, at));
    if (why != MotionError::none) return why;
    if (!(pauses ? may_begin(stop, from) : may_begin(next, from)))
        return MotionError::software_limit;
    if (pauses)
        velocity_motion = stop;
    else
        point_motion = next;
    doing = pauses ? Doing::following_velocity : Doing::moving_to_point;
    leg.exists = 0;
    paused = pauses ? 1 : 0;
    lasting = end_velocity;
    goal = to;
    return why;
}

/// The position is known at once, at the end of the move, or where the signal came: from there the
/// axis stops.
MotionError Axis::plan_homing(const Request& request, const Moment& at, Start& from) {
    const bool is_relative = request.homing == HomingMode::relative;
    const bool is_outside = modulo && (request.position < 0 || request.position >= period);
    if (request.homing == HomingMode::other || (is_outside && !is_relative))
        return MotionError::out_of_range;
    if (request.homing == HomingMode::to_position)
        return plan_point(request, target_of(request, from), at, from);
    Request search = request;
    search.command =
        request.homing == HomingMode::on_signal ? Command::move_velocity : Command::stop;
    search.velocity = asked_of(request).velocity;
    if (request.homing == HomingMode::on_signal) return plan_velocity(search, at, from);
    Start known = from;
    known.state.position = request.position + (is_relative ? from.state.position : 0);
    const MotionError why = plan_velocity(search, at, known);
    if (why != MotionError::none) return why;
    relocated += known.state.position - from.state.position;
    ++renamed;
    from = known;
    return why;
}

/// A halt under way is never made longer: with less jerk it would even turn round.
bool Axis::stands_sooner(const Dynamics& d, const Moment& at, const Start& from) const {
    VelocityMotion anew;
    const double left = velocity_motion.ramp.duration - velocity_motion.start.until(at.time);
    return anew.begin(from.state, 0, d, at) == PlanResult::ok && anew.ramp.duration < left;
}

/// The motion under way with other limits, or with another way left, and what is blended into it.
void Axis::replan(const Context& context, const Moment& at) {
    look_ahead(context);
    if (state == AxisState::disabled || state == AxisState::error_stop) return;
    const Start from = start_again();
    const Dynamics d = dynamics_of(active.request);
    if (doing == Doing::moving_to_point || paused != 0) {
        if (go_to(goal, lasting, d, at, from) != MotionError::none) return;
    } else if (doing == Doing::following_velocity ||
               (doing == Doing::holding && base.velocity != lasting * factors.velocity)) {
        if (lasting == 0 && !stands_sooner(d, at, from)) return;
        if (go_on(lasting, d, at, from) != MotionError::none) return;
        if (active.exists()) tell(context, active, Progress::active);
    } else {
        return;
    }
    base = from.state;
    offset = 0;
    if (queue.first != nowhere) blend(context, at);
}

}  // namespace lineshaft

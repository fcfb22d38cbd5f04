#include <cassert>
#include <cmath>

#include "blocks/axis/axis.hpp"
#include "blocks/inputs.hpp"
#include "runtime/model/device.hpp"

namespace lineshaft {

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
            if (state == AxisState::stopping && rules_of(request.rules).reset_ends_stop)
                release(context, at);
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
            return write_parameter(context, request.parameter, request.parameter_value);
        case Command::write_parameter:
            return write_parameter(context, request.parameter, request.parameter_value);
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
    switched_by = request.rules;
    enables_positive = request.enables_positive;
    enables_negative = request.enables_negative;
    if (state == AxisState::error_stop) return;
    if (!on && is_at_work() && rules_of(request.rules).fails_without_power) {
        fail(context, at, MotionError::axis_disabled);
    } else if (!on) {
        brake(at);
        abort_all(context);
        state = AxisState::disabled;
    } else if (doing == Doing::holding) {
        if (state == AxisState::disabled) powered_in = scan_index;
        come_to_rest(context);
    }
}

/// It moves, or a command is about to move it: none that holds it, or follows what stands.
bool Axis::is_at_work() const {
    const MotionState now = total();
    const bool moves = now.velocity != 0 || now.acceleration != 0;
    const bool waits =
        active.exists() && active.told_end == 0 && doing != Doing::following_axes && !is_led();
    return state != AxisState::disabled && (moves || waits);
}

void Axis::begin_without_power(const Context& context) {
    if (switched != 0 || started == 0 || task != context.task) return;
    if (state == AxisState::standstill) state = AxisState::disabled;
}

/// Whether MC_Power enables the direction of a way, or of a velocity.
bool Axis::may_go(double way) const {
    return way == 0 || (way > 0 ? enables_positive : enables_negative) != 0;
}

/// What goes in a direction that is not enabled brakes, and that is an error by most rules: but for
/// what brakes already.
void Axis::keep_directions(const Context& context) {
    constexpr double rounding = 1e-9;
    const double v = total().velocity;
    const bool brakes = doing == Doing::following_velocity && !added.exists() &&
                        velocity_motion.ramp.end.velocity == 0;
    if (may_go(v) || brakes || state == AxisState::disabled) return;
    if (std::abs(v) <= rounding * default_velocity) return;
    if (!rules_of(switched_by).stops_at_directions)
        return fail(context, {scan_time}, MotionError::direction_not_enabled);
    brake({scan_time});
    abort_all(context);
    state = AxisState::stopping;
    stopped = 1;
}

/// By rules that want what moves an axis to be called in each scan of its task: one that has gone
/// by without a call is an error.
void Axis::watch_calls(const Context& context) {
    if (!active.exists()) return;
    const Job& job = context.at<Job>(active.place);
    const std::int64_t scans = context.published[job.task];
    if (job.ticket == active.ticket && scans != never && job.called + 1 < scans)
        fail(context, {scan_time}, MotionError::not_called);
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
        const Dynamics d = to_stand(dynamics_of(job.request), from);
        const PlanResult planned = anew.begin(from, 0, d, at);
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
    const bool is_other = active.place != context.place_of(job);
    if (is_other && active.told_end == 0) tell(context, active, Progress::aborted);
    active = {context.place_of(job), job.ticket, job.request, 0};
    tell(job, Progress::active);
    if (doing == Doing::holding) end_stop(context, at);
}

/// The MC_Stop at work does not hold the axis any more.
void Axis::release(const Context& context, const Moment& at) {
    active.request.holds = 0;
    if (active.told_end != 0) end_hold(context, at);
}

void Axis::leave_error() {
    error = false;
    error_id = MotionError::none;
    state = powered != 0 ? AxisState::standstill : AxisState::disabled;
}

MotionError Axis::set_position(const Context& context, const Moment& at, const Request& request) {
    const bool relative = request.relative != 0, counts_turns = request.period < 0;
    const bool is_outside = request.position < 0 || request.position >= period;
    if (modulo && !relative && !counts_turns && is_outside) return MotionError::out_of_range;
    const bool waited = request.mode != BufferMode::aborting;  // for an end since the last scan
    const double place = waited ? total().position : position + turns * period;
    const double in_period = waited && modulo ? within_period(place, period) : position;
    const double here = counts_turns || !modulo ? place : in_period;
    const double by = relative ? request.position : request.position - here;
    ++renamed;
    call_place(place + by);
    offset += by;
    relocated += by;
    position_offset = request.reference == Referencing::unchanged ? position_offset + by : 0;
    goal += by;
    origin += by;
    const bool is_known = request.reference == Referencing::known;
    homed = is_known || (homed && request.reference == Referencing::unchanged);
    if (is_known && active.exists() && active.request.command == Command::move_absolute) {
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

}  // namespace lineshaft

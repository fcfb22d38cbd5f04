#include <algorithm>
#include <cmath>

#include "blocks/axis/axis.hpp"
#include "blocks/axis/cam_table.hpp"

namespace lineshaft {

namespace {

double sign_of(double x) {
    return x < 0 ? -1 : 1;
}

ProfileOf profile_of(Command command) {
    return command == Command::position_profile   ? ProfileOf::position
           : command == Command::velocity_profile ? ProfileOf::velocity
                                                  : ProfileOf::acceleration;
}

}  // namespace

/// With all the way that is on top: where it aborts as far as that has come, else to its end.
Axis::Start Axis::start_of(const Request& request, bool drops_added) const {
    Start from = start_again();
    from.taken = request.mode != BufferMode::aborting && !drops_added ? added_goal : extra.position;
    from.state.position += from.taken;
    from.drops_added = drops_added;
    if (drops_added) from.state = total();
    const bool from_goal =
        request.command == Command::move_additive && state == AxisState::discrete_motion;
    from.origin = from_goal ? goal + from.taken : from.state.position;
    return from;
}

/// Where `active` began, to plan it anew.
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

/// With the jerk that keeps a halt from turning round, as far as the axis or what is under way has
/// so much.
Dynamics Axis::to_stand(const Dynamics& d, const MotionState& from) const {
    double most = defaults().jerk;
    if (doing == Doing::moving_to_point) most = std::max(most, point_motion.greatest_jerk());
    if (doing == Doing::following_velocity) most = std::max(most, velocity_motion.greatest_jerk());
    if (extra.velocity != 0 || extra.acceleration != 0)
        most = std::max(most, added_motion.greatest_jerk());
    return without_turning(d, from, most);
}

/// To a velocity and on with it, both with the override; in any case, or where limits allow.
MotionError Axis::go_on(double with, const Dynamics& d, const Moment& at, const Start& from,
                        bool in_any_case) {
    VelocityMotion next;
    const double wanted = with * factors.velocity;
    const MotionError why = motion_error_of(
        next.begin(from.state, wanted, wanted == 0 ? to_stand(d, from.state) : d, at));
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
        pauses ? stop.begin(from.state, 0, to_stand(d, from.state), at)
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
    if (request.reference == Referencing::unchanged) return plan_velocity(search, at, from);
    Start known = from;
    known.state.position = request.position + (is_relative ? from.state.position : 0);
    const MotionError why = plan_velocity(search, at, known);
    if (why != MotionError::none) return why;
    relocated += known.state.position - from.state.position;
    position_offset = 0;
    ++renamed;
    from = known;
    return why;
}

/// A halt under way is never made longer.
bool Axis::stands_sooner(const Dynamics& d, const Moment& at, const Start& from) const {
    VelocityMotion anew;
    const double left = velocity_motion.ramp.duration - velocity_motion.start.until(at.time);
    return anew.begin(from.state, 0, to_stand(d, from.state), at) == PlanResult::ok &&
           anew.ramp.duration < left;
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

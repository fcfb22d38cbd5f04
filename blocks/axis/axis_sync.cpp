#include <algorithm>
#include <cmath>

#include "blocks/axis/axis.hpp"
#include "blocks/axis/cam_table.hpp"
#include "blocks/axis/written_cam.hpp"

namespace lineshaft {

namespace {

using Law = SyncMotion::Law;
using Stage = SyncMotion::Stage;

/// Of positions that have been added to others.
constexpr double sum_rounding = 0x1p-40;

Law law_of(Command command) {
    if (command == Command::gear_in_pos) return Law::positioned;
    return command == Command::cam_in ? Law::cammed : Law::geared;
}

MotionError sync_error(CurveFault fault) {
    if (fault == CurveFault::none) return MotionError::none;
    return fault == CurveFault::standing_master ? MotionError::master_stands
                                                : MotionError::sync_limits;
}

MotionError sync_error(PlanResult result) {
    if (result == PlanResult::ok) return MotionError::none;
    if (result == PlanResult::velocity_above_limit) return MotionError::sync_limits;
    return result == PlanResult::not_finite ? MotionError::not_finite
                                            : MotionError::limit_not_positive;
}

/// How long ago something was at a position, at most `most` [s].
double time_since(const MotionState& now, double position, double most) {
    const double side = now.after(-most).position - position;
    double low = 0, high = most;
    for (double m = 0.5 * high; m > low && m < high; m = 0.5 * (low + high))
        ((now.after(-m).position - position) * side > 0 ? high : low) = m;
    return high;
}

/// The period of a cam that begins, in the direction of its master, where it is met.
double period_at_sync(const SyncMotion& sync, const Cam& table) {
    constexpr double nearly = 1e-9;
    const double x = sync.coupling.master_scaling * sync.sync_x + sync.cam_origin;
    const double periods = (x - table.begin()) / table.length(), nearest = std::round(periods);
    if (std::abs(periods - nearest) > nearly) return std::floor(periods);
    return sync.coupling.master_scaling * sync.direction > 0 ? nearest : nearest - 1;
}

/// At which of its ends a cam that is not periodic is over.
void find_end(SyncMotion& sync, const MotionState& leader, const Cam& table) {
    const double x = sync.coupling.master_scaling * leader.position + sync.cam_origin;
    sync.last_periods = table.periods(x);
    sync.ends_at = x <= table.begin() ? 1 : x >= table.points.back().x ? -1 : 0;
    if (!table.periodic && sync.coupling.stays != 0)
        sync.last_periods = -static_cast<double>(sync.ends_at);
}

/// After how much of its master's way a place comes again; 0: never.
double turn_of(const SyncMotion& sync, const Cam& table, double modulo) {
    if (sync.law == Law::positioned) return modulo;
    if (table.periodic) return table.length() / std::abs(sync.coupling.master_scaling);
    return CamTableId::of(sync.coupling.cam).master_absolute ? modulo : 0;
}

/// A place that the master has passed in its turn, or where it is, is met in the next one.
void meet_in_next_turn(SyncMotion& sync, const MotionState& leader, double turn, const Cam& table) {
    const Coupling& c = sync.coupling;
    const double way = sync.direction * turn * (std::floor(-sync.distance(leader) / turn) + 1);
    const double before = sync.law_at(leader.position, table).y;
    sync.sync_x += way;
    if (sync.law == Law::positioned || table.periodic) return;
    sync.cam_origin -= c.master_scaling * way;
    if (!CamTableId::of(c.cam).slave_absolute || c.start_mode == StartMode::relative)
        sync.cam_rise += before - sync.law_at(leader.position, table).y;
    find_end(sync, leader, table);
}

}  // namespace

bool is_synchronous(Command command) {
    using enum Command;
    return command == gear_in || command == gear_in_pos || command == cam_in ||
           command == combine_axes;
}

bool is_phasing(Command command) {
    return command == Command::phasing_absolute || command == Command::phasing_relative;
}

// Beginnings.

MotionError Axis::plan_sync(const Context& context, const Request& request, const Moment& at,
                            const Start& from) {
    if (const MotionError why = check_masters(context, request.coupling); why != MotionError::none)
        return why;
    const Dynamics d = dynamics_of(request);
    if (!d.valid()) return MotionError::limit_not_positive;
    const SyncMotion last = sync;
    sync = {};
    sync.law = law_of(request.command);
    sync.coupling = request.coupling;
    sync.dynamics = d;
    const MotionError why = sync.law == Law::geared ? get_onto_guide(context, at, from.state)
                                                    : join_law(context, at, from.state);
    if (why != MotionError::none) {
        sync = last;
        return why;
    }
    doing = Doing::following_axes;
    leg.exists = paused = 0;
    lasting = 0;
    origin = goal = from.origin;
    offset = 0;
    base = from.state;
    return why;
}

MotionError Axis::get_onto_guide(const Context& context, const Moment& at,
                                 const MotionState& from) {
    const MotionState guide = sync.guide(master(context), led_by(context, sync.coupling.second))
                                  .after(-at.until(scan_time));
    sync.goal_offset = from.position - guide.position;
    if (plans_in_steps())
        return lacks(guide, sync.step_towards(from, guide, at, transition_quantum));
    return lacks(guide, sync.get_onto(from, guide, at));
}

/// A change of the velocity alone, that is not made at once.
bool Axis::plans_in_steps() const {
    return transition_quantum > 0 && sync.coupling.catch_up == 0 &&
           sync.coupling.transition != TransitionMode::step;
}

MotionError Axis::join_law(const Context& context, const Moment& at, const MotionState& from) {
    const MotionState leader = master(context).after(-at.until(scan_time));
    const Axis& leading = context.seen_instance<Axis>(sync.coupling.master.axis);
    const Coupling& c = sync.coupling;
    sync.sync_y = c.slave_sync;
    if (sync.law == Law::positioned)
        sync.meet(leader, c.master_sync - leading.relocated, leading.modulo ? leading.period : 0);
    else if (const MotionError why = place_cam(context, leader, from); why != MotionError::none)
        return why;
    const Cam table = cam(context);
    const bool is_cam = sync.law == Law::cammed;
    sync.stage = Stage::in_sync;
    sync.looked = at;
    sync.led = leader;
    if (is_cam && c.start_mode == StartMode::direct) return MotionError::none;
    if (is_cam && c.start_mode == StartMode::ramp_in) return ramp_in(from, leader, table, at);
    if (sync.is_on_law(from, leader, table)) return MotionError::none;
    double left = sync.distance(leader);
    const bool begins_here = is_cam && std::abs(left) <= sum_rounding * std::abs(leader.position);
    if (begins_here && sync.is_beside_law(from, leader, table)) return MotionError::none;
    if (begins_here && !CamTableId::of(c.cam).master_absolute)
        return ramp_in(from, leader, table, at);
    const double turn = turn_of(sync, table, leading.modulo ? leading.period : 0);
    if (!(left > 0) && turn > 0) {
        meet_in_next_turn(sync, leader, turn, table);
        left = sync.distance(leader);
    }
    if (!(left > 0)) return MotionError::sync_passed;
    if (c.start_distance == 0 || left <= c.start_distance)
        return approach(context, from, table, at);
    sync.stage = Stage::waiting;
    sync.start = at;
    const double rest = from.acceleration * std::abs(from.acceleration) / (2 * sync.dynamics.jerk);
    return sync_error(velocity_motion.begin(from, from.velocity + rest, sync.dynamics, at));
}

/// Onto the cam wherever the master is.
MotionError Axis::ramp_in(const MotionState& from, const MotionState& leader, const Cam& table,
                          const Moment& at) {
    const double y = sync.law_at(leader.position, table).y;
    if (modulo) sync.cam_rise += period * std::round((from.position - y) / period);
    sync.coupling.catch_up = 1;
    sync.coupling.transition = TransitionMode::jerk_limited;
    sync.goal_offset = 0;
    const MotionState guide = sync.law_at(leader.position, table).led_by(leader);
    return lacks(guide, sync.get_onto(from, guide, at));
}

MotionError Axis::approach(const Context& context, const MotionState& from, const Cam& table,
                           const Moment& at) {
    const bool steady = is_steady(context);
    const Forecast ahead = foresee(context).after(at.until(scan_time), sync.led);
    const CurveFault fault = sync.approach(from, ahead, table, modulo ? period : 0, steady, at);
    if (fault != CurveFault::none) shortage = sync.shortage(from, ahead, steady);
    if (sync.way == SyncMotion::Way::rest) velocity_motion.begin(from, 0, sync.dynamics, at);
    return sync_error(fault);
}

/// What of a guide is faster than the slave may be.
MotionError Axis::lacks(const MotionState& guide, PlanResult result) {
    if (result == PlanResult::velocity_above_limit)
        shortage = {CurveFault::velocity, std::abs(guide.velocity), sync.dynamics.velocity};
    return sync_error(result);
}

/// A relative cam begins, on its axis, at MasterOffset and, for the slave, where the slave is. One
/// that is executed once ends at the other end than it is entered by.
MotionError Axis::place_cam(const Context& context, const MotionState& leader,
                            const MotionState& from) {
    const Coupling& c = sync.coupling;
    const CamTableId id = CamTableId::of(c.cam);
    const Cam table = WrittenCam::find(context, id);
    if (table.points.empty()) return MotionError::no_cam;
    const double relocated_by = context.seen_instance<Axis>(c.master.axis).relocated;
    sync.cam_origin =
        c.master_offset + c.master_scaling * (id.master_absolute ? relocated_by : -leader.position);
    sync.cam_rise = c.slave_offset;
    if (c.start_mode == StartMode::direct)
        place_direct_cam(context, leader, from, table);
    else if (!id.slave_absolute || c.start_mode == StartMode::relative)
        sync.cam_rise += from.position - sync.law_at(leader.position, table).y;
    sync.meet(leader, (c.master_sync - sync.cam_origin) / c.master_scaling,
              table.periodic ? table.length() / std::abs(c.master_scaling) : 0);
    find_end(sync, leader, table);
    return MotionError::none;
}

/// Its origin is where the slave is, or the axis' own. It begins with its first period, and of a
/// modulo axis with the turn that the axis is in.
void Axis::place_direct_cam(const Context& context, const MotionState& leader,
                            const MotionState& from, const Cam& table) {
    const Coupling& c = sync.coupling;
    const Axis& leading = context.seen_instance<Axis>(c.master.axis);
    if (leading.modulo && CamTableId::of(c.cam).master_absolute) {
        const double at = leader.position + leading.relocated;
        sync.cam_origin += c.master_scaling * (within_period(at, leading.period) - at);
    }
    const double x = c.master_scaling * leader.position + sync.cam_origin;
    if (!CamTableId::of(c.cam).slave_absolute) sync.cam_rise += from.position;
    if (table.periodic) sync.cam_rise -= c.slave_scaling * table.periods(x) * table.lift();
    const double y = sync.law_at(leader.position, table).y;
    if (modulo) sync.cam_rise += period * std::round((from.position - y) / period);
}

Cam Axis::cam(const Context& context) const {
    if (sync.law != Law::cammed) return {};
    return WrittenCam::followed(context, CamTableId::of(sync.coupling.cam));
}

void Axis::begin_phasing(const Context& context, Job& job) {
    const Request& request = job.request;
    const Dynamics d = dynamics_of(request);
    const bool relative = request.command == Command::phasing_relative;
    const double to = request.position + (relative ? sync.shift.position : 0);
    const PlanResult planned = d.valid() ? sync.shifting.begin(sync.shift, to, 0, d, {scan_time})
                                         : PlanResult::limit_not_positive;
    if (planned != PlanResult::ok) return tell(job, Progress::failed, sync_error(planned));
    const std::int64_t place = context.place_of(job);
    if (phased.place != place || phased.ticket != job.ticket) {
        end(context, phased, Progress::aborted);
        phased = {place, job.ticket, request, 0, sync.shift.position};
    }
    phased.request = request;
    tell(job, Progress::active);
}

// Each scan.

void Axis::look_at_shift(const Context& context) {
    if (!phased.exists()) return;
    const bool has_ended = sync.shifting.has_ended(scan_time);
    sync.shift = has_ended ? sync.shifting.plan.end : sync.shifting.at(scan_time);
    phased.covered = sync.shift.position - phased.from;
    if (has_ended) end(context, phased, Progress::done);
}

/// Axes of different tasks that are coupled to each other in the same moment do not see it then.
bool Axis::follows_itself(const Context& context) const {
    const auto is_of_other_task = [&](const MasterLink& link) {
        return link.axis >= 0 &&
               &context.seen_instance<Axis>(link.axis) != &context.instance<Axis>(link.axis);
    };
    const Coupling& c = sync.coupling;
    return (is_of_other_task(c.master) || is_of_other_task(c.second)) &&
           way_to(context, *this) >= 0;
}

void Axis::follow(const Context& context) {
    if (follows_itself(context)) return fail_before(context, MotionError::master_loop);
    look_at_shift(context);
    if (sync.law == Law::geared)
        follow_guide(context);
    else
        follow_law(context);
}

/// In gear it follows whatever its master has done since.
void Axis::follow_guide(const Context& context) {
    const MotionState guide = sync.guide(master(context), led_by(context, sync.coupling.second));
    if (sync.stage == Stage::in_transition && sync.in_steps != 0) {
        if (!follow_steps(context, guide)) return;
    } else if (sync.stage == Stage::in_transition) {
        if (!gets_onto(context, guide, sync.coupling.is_measured())) return;
        sync.offset = sync.transition.plan.end.position;
        reach(context);
        if (doing != Doing::following_axes || sync.stage != Stage::in_sync) return;
    }
    base = guide;
    base.position += sync.offset;
}

/// Whether the slave has got onto its guide. One that never moves as foreseen, as what is measured,
/// may be reached with a scan.
bool Axis::gets_onto(const Context& context, const MotionState& guide, bool with_scan) {
    const double t = sync.start.until(scan_time);
    base = sync.transition.at(t);
    double left = sync.transition.plan.duration - t;
    if (left > Moment::same_scan && !sync.transition.foresees(guide, t)) {
        const MotionError why = lacks(guide, sync.get_onto(base, guide, {scan_time}));
        if (why != MotionError::none) fail(context, {scan_time}, why);
        if (why != MotionError::none) return false;
        left = sync.transition.plan.duration - (with_scan ? seconds(scan_interval) : 0);
    }
    return left <= Moment::same_scan;
}

/// The steps last what they last, whatever the motion clock: where one ended between two scans, the
/// next began. Whether the axis is in gear.
bool Axis::follow_steps(const Context& context, const MotionState& guide) {
    const MotionState steady = sync.as_foreseen(guide);
    while (sync.start.has_passed(transition_quantum, scan_time)) {
        const MotionState end = sync.step.after(transition_quantum);
        const Moment at = sync.start.after(transition_quantum);
        const MotionState guide_then = steady.after(-at.until(scan_time));
        if (sync.steps_left == 0 && is_matched(end, guide_then)) {
            sync.offset = end.position - guide_then.position;
            reach(context);
            return doing == Doing::following_axes && sync.stage == Stage::in_sync;
        }
        const MotionError why =
            lacks(guide_then, sync.step_towards(end, guide_then, at, transition_quantum));
        if (why != MotionError::none) {
            fail(context, {scan_time}, why);
            return false;
        }
    }
    base = sync.step.after(sync.start.until(scan_time));
    return false;
}

/// A guide that has not moved as foreseen is met as near as a scan's acceleration comes.
bool Axis::is_matched(const MotionState& slave, const MotionState& guide) const {
    const double a = std::max(sync.dynamics.acceleration, sync.dynamics.deceleration);
    return std::abs(slave.velocity - guide.velocity) <= a * seconds(scan_interval);
}

void Axis::reach(const Context& context) {
    sync.stage = Stage::in_sync;
    sync.reached = 1;
    if (active.exists()) tell(context, active, Progress::reached);
    if (queue.first != nowhere && sync.holds()) begin_next(context, {scan_time});
}

void Axis::follow_law(const Context& context) {
    const MotionState leader = master(context);
    const Cam table = cam(context);
    if (sync.law == Law::cammed && table.points.empty())
        return fail_before(context, MotionError::no_cam);
    if (sync.stage == Stage::waiting && !leaves(context, leader, table)) return;
    if (sync.stage == Stage::approaching) {
        follow_approach(context, leader, table);
        if (sync.stage == Stage::in_sync && table.periodic)
            sync.last_periods = period_at_sync(sync, table);
    }
    if (sync.stage == Stage::in_transition &&
        gets_onto(context, sync.law_at(leader.position, table).led_by(leader), true)) {
        sync.stage = Stage::in_sync;
        if (table.periodic)
            sync.last_periods =
                table.periods(sync.coupling.master_scaling * sync.led.position + sync.cam_origin);
    }
    if (doing == Doing::following_axes && sync.stage == Stage::in_sync)
        follow_in_sync(context, leader, table);
    sync.looked = {scan_time};
    sync.led = leader;
}

/// Whether the slave that has waited for its master to come near is on its way now.
bool Axis::leaves(const Context& context, const MotionState& leader, const Cam& table) {
    base = velocity_motion.at(scan_time);
    if (sync.distance(leader) > sync.coupling.start_distance) return false;
    sync.led = leader;
    const MotionError why = approach(context, base, table, {scan_time});
    if (why != MotionError::none) fail(context, {scan_time}, why);
    if (why != MotionError::none) return false;
    tell(context, active, Progress::approaching);
    return true;
}

/// What the master does is known a scan late: where it does not suit, the slave goes on from the
/// state of the scan before, which was within limits.
void Axis::follow_approach(const Context& context, const MotionState& leader, const Cam& table) {
    using Approach = SyncMotion::Way;
    const bool steady = is_steady(context);
    const double since = sync.looked.until(scan_time), now = sync.start.until(scan_time);
    const auto can_be = [&](const MotionState& next) {
        return !steady || !(since > 0) ||
               check_step(base, next, since, sync.limits_of(sync.curve, sync.dynamics)) ==
                   CurveFault::none;
    };
    if (sync.distance(leader) <= 0) {
        const bool foreseen = sync.way == Approach::curve || now >= sync.meeting.time;
        if (!foreseen && !can_be(sync.law_at(leader.position, table).led_by(leader)))
            return fail_before(context, MotionError::sync_limits);
        sync.stage = Stage::in_sync;
        return;
    }
    const Forecast ahead = foresee(context).after(since, sync.led);
    Meeting met = sync.meet(ahead);
    met.time += now - since;
    const bool on_curve = sync.way == Approach::curve;
    const bool keeps_curve = on_curve && can_be(sync.curve.at(leader.position).led_by(leader));
    if (!met.agrees(sync.meeting) || (on_curve && !keeps_curve)) {
        const CurveFault fault = sync.approach_anew(base, ahead, keeps_curve, steady, sync.looked);
        if (fault != CurveFault::none) shortage = sync.shortage(base, ahead, steady);
        if (fault != CurveFault::none) return fail_before(context, MotionError::sync_limits);
        if (sync.way == Approach::rest) velocity_motion.begin(base, 0, sync.dynamics, sync.looked);
    }
    base = sync.way == Approach::curve   ? sync.curve.at(leader.position).led_by(leader)
           : sync.way == Approach::timed ? sync.timed.at(sync.start.until(scan_time))
                                         : velocity_motion.at(scan_time);
}

/// An error that began a scan ago: so does the stop.
void Axis::fail_before(const Context& context, MotionError why) {
    fail(context, sync.looked, why);
    base = velocity_motion.at(scan_time);
}

void Axis::follow_in_sync(const Context& context, const MotionState& leader, const Cam& table) {
    base = sync.law_at(leader.position, table).led_by(leader);
    if (sync.finished != 0) base = velocity_motion.at(scan_time);
    const Running before = active;
    if (sync.reached == 0 || !active.exists()) reach(context);
    if (active.place != before.place || active.ticket != before.ticket) return;
    if (doing == Doing::following_axes && sync.law == Law::cammed && sync.finished == 0)
        look_for_end(context, leader, table);
}

/// EndOfProfile: the command sees by the number that a cam has ended.
void Axis::look_for_end(const Context& context, const MotionState& leader, const Cam& table) {
    const double scaling = sync.coupling.master_scaling;
    const double x = scaling * leader.position + sync.cam_origin;
    const double slack = sum_rounding * (std::abs(x) + std::abs(sync.cam_origin));
    const double first = table.begin(), last = table.points.back().x;
    if (table.periodic) {
        const double periods = table.periods(x), before = sync.last_periods;
        const double way = periods > before ? 1 : -1;
        const double end = first + table.length() * (way > 0 ? periods : periods + 1);
        const bool comes_from_there = way * scaling * leader.velocity < 0;
        if (periods == before || (comes_from_there && std::abs(x - end) <= slack)) return;
        sync.last_periods = periods;
        return end_cam(context, leader, end, table.at(end));
    }
    CurvePoint behind = table.last();
    behind.y = table.points.back().y;
    if (sync.coupling.stays != 0) {
        const double side = x >= last - slack ? 1 : x <= first + slack ? -1 : 0;
        const bool leaves = side != 0 && side != sync.last_periods;
        sync.last_periods = side;
        if (!leaves) return;
        return end_cam(context, leader, side > 0 ? last : first,
                       side > 0 ? behind : table.at(first));
    }
    if (sync.ends_at >= 0 && x >= last - slack) return end_cam(context, leader, last, behind);
    if (sync.ends_at <= 0 && x <= first + slack) end_cam(context, leader, first, table.at(first));
}

/// What waits begins at the moment when the master was at the end, with the slave's motion there.
void Axis::end_cam(const Context& context, const MotionState& leader, double x,
                   const CurvePoint& point) {
    if (active.exists()) {
        Job& job = context.at<Job>(active.place);
        if (job.ticket == active.ticket) job.told_value += 1;
    }
    tell(context, active, Progress::reached);
    const double end = (x - sync.cam_origin) / sync.coupling.master_scaling;
    const double since = sync.looked.until(scan_time);
    const double back = time_since(leader, end, since);
    const Moment at = sync.looked.after(since - back);
    const MotionState now = base;
    const MotionState last = sync.on_axis(point).led_by(leader.after(-back));
    if (queue.first != nowhere) {
        const Running before = active;
        base = last;
        begin_next(context, at);
        if (active.place != before.place || active.ticket != before.ticket)
            return look(context, scan_time);
        base = now;
    }
    if (cam(context).periodic || sync.coupling.stays != 0) return;
    sync.finished = 1;
    const bool stands = std::abs(last.velocity) <= sum_rounding * sync.dynamics.velocity;
    if (stands)
        velocity_motion.hold({last.position}, at);
    else
        velocity_motion.begin(last, 0, sync.dynamics, at);
    base = velocity_motion.at(scan_time);
}

}  // namespace lineshaft

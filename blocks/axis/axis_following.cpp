#include <algorithm>
#include <cmath>

#include "blocks/axis/axis.hpp"
#include "blocks/axis/cam_table.hpp"

namespace lineshaft {

namespace {

using Law = SyncMotion::Law;
using Stage = SyncMotion::Stage;

/// How long ago something was at a position, at most `most` [s].
double time_since(const MotionState& now, double position, double most) {
    const double side = now.after(-most).position - position;
    double low = 0, high = most;
    for (double m = 0.5 * high; m > low && m < high; m = 0.5 * (low + high))
        ((now.after(-m).position - position) * side > 0 ? high : low) = m;
    return high;
}

}  // namespace

void Axis::look_at_shift(const Context& context) {
    if (!phased.exists()) return;
    const bool has_ended = sync.shifting.has_ended(scan_time);
    sync.shift = has_ended ? sync.shifting.plan.end : sync.shifting.at(scan_time);
    phased.covered = sync.shift.position - phased.from;
    if (has_ended) end(context, phased, Progress::done);
}

/// The axes that it follows know of it from the scan on in which that changes.
void Axis::count_masters(const Context& context) {
    is_counted = doing == Doing::following_axes;
    const auto count = [&](std::int64_t& counted_one, std::int64_t master) {
        if (counted_one == master) return;
        const auto change = [&](std::int64_t by) {
            if (counted_one == nowhere) return;
            Axis& leader = context.instance<Axis>(counted_one);
            leader.followers = std::max<std::int64_t>(0, leader.followers + by);
        };
        change(-1);
        counted_one = master;
        change(1);
    };
    count(counted, is_counted ? sync.coupling.master.axis : nowhere);
    count(counted_second, is_counted ? sync.coupling.second.axis : nowhere);
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
        if (!gets_onto(context, guide)) return;
        sync.offset = sync.transition.plan.end.position;
        reach(context);
        if (doing != Doing::following_axes || sync.stage != Stage::in_sync) return;
    }
    base = guide;
    base.position += sync.offset;
}

/// Whether the slave has got onto its guide. A plan that ends before the next scan is kept, also
/// for a guide that never moves as foreseen, as what is measured.
bool Axis::gets_onto(const Context& context, const MotionState& guide) {
    const double t = sync.start.until(scan_time);
    base = sync.transition.at(t);
    double left = sync.transition.plan.duration - t;
    if (left > Moment::same_scan && !sync.transition.foresees(guide, t)) {
        const MotionError why = lacks(guide, sync.get_onto(base, guide, {scan_time}));
        if (why != MotionError::none) fail(context, {scan_time}, why);
        if (why != MotionError::none) return false;
        left = sync.transition.plan.duration;
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

/// With another ratio, as one that creeps from scan to scan.
bool Axis::keeps_gear(const Context& context) const {
    const bool is_geared = doing == Doing::following_axes && sync.law == Law::geared;
    if (!is_geared || sync.coupling.catch_up != 0) return false;
    return is_matched(base, sync.guide(master(context), led_by(context, sync.coupling.second)));
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
    if (sync.stage < Stage::in_transition && leader.velocity * sync.direction < 0)
        if (const MotionError why = turn_to_master(context, leader, table);
            why != MotionError::none)
            return fail(context, {scan_time}, why);
    if (sync.stage == Stage::waiting && !leaves(context, leader, table)) return;
    if (sync.stage == Stage::approaching) {
        follow_approach(context, leader, table);
        if (sync.stage == Stage::in_sync && table.periodic)
            sync.enter_period(sync.period_from(sync.sync_x, sync.direction, table));
    }
    if (sync.stage == Stage::in_transition &&
        gets_onto(context, sync.law_at(leader.position, table).led_by(leader))) {
        sync.stage = Stage::in_sync;
        if (table.periodic)
            sync.enter_period(
                table.periods(sync.coupling.master_scaling * sync.led.position + sync.cam_origin));
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
        if (sync.period_is_open != 0) {
            const double seam = first + table.length() * std::round((x - first) / table.length());
            if (std::abs(x - seam) > slack) sync.enter_period(periods);
            return;
        }
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

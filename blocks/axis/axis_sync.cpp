#include <cmath>
#include <limits>

#include "blocks/axis/axis.hpp"
#include "blocks/motion/cam_table.hpp"

namespace lineshaft {

namespace {

using Law = SyncMotion::Law;
using Stage = SyncMotion::Stage;

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

bool is_measured(const Coupling& c) {
    return c.master.source == MasterValueSource::actual_value ||
           c.second.source == MasterValueSource::actual_value;
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

// Masters.

MotionState Axis::led_by(const Context& context, const MasterLink& link) const {
    if (link.axis < 0) return {};
    const Axis& leader = context.seen_instance<Axis>(link.axis);
    const bool measured = link.source == MasterValueSource::actual_value && leader.has_drive;
    MotionState seen =
        measured ? MotionState{leader.actual_position, leader.actual_velocity} : leader.total();
    seen.position -= leader.relocated;
    return seen;
}

/// As the axis sees it.
MotionState Axis::master(const Context& context) const {
    MotionState seen = led_by(context, sync.coupling.master);
    seen.position += sync.shift.position;
    seen.velocity += sync.shift.velocity;
    seen.acceleration += sync.shift.acceleration;
    seen.jerk += sync.shift.jerk;
    return seen;
}

std::int64_t Axis::way_to(const Context& context, const Axis& leader,
                          const Coupling& coupling) const {
    for (const MasterLink* link : {&coupling.master, &coupling.second})
        if (link->axis >= 0 &&
            (&context.instance<Axis>(link->axis) == &leader ||
             context.seen_instance<Axis>(link->axis).way_to(context, leader) >= 0))
            return link->axis;
    return nowhere;
}

std::int64_t Axis::way_to(const Context& context, const Axis& leader) const {
    return doing == Doing::following_axes ? way_to(context, leader, sync.coupling) : nowhere;
}

/// Siemens' ratios are two DINT, the denominator above 0.
bool Axis::admits(const MasterLink& link) const {
    if (profile == AxisProfile::plcopen) return link.denominator != 0;
    const auto is_dint = [](double x) {
        return std::trunc(x) == x && std::abs(x) <= std::numeric_limits<std::int32_t>::max();
    };
    return is_dint(link.numerator) && is_dint(link.denominator) && link.numerator != 0 &&
           link.denominator > 0;
}

MotionError Axis::check_masters(const Context& context, const Coupling& c) const {
    if (c.master.axis < 0) return MotionError::no_master;
    if (!admits(c.master) || !admits(c.second) || c.master_scaling == 0 || c.start_distance < 0)
        return MotionError::out_of_range;
    return way_to(context, *this, c) >= 0 ? MotionError::master_loop : MotionError::none;
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
    return sync_error(sync.get_onto(from, guide, at));
}

MotionError Axis::join_law(const Context& context, const Moment& at, const MotionState& from) {
    const MotionState leader = master(context).after(-at.until(scan_time));
    const Axis& leading = context.seen_instance<Axis>(sync.coupling.master.axis);
    sync.sync_y = sync.coupling.slave_sync;
    if (sync.law == Law::positioned)
        sync.meet(leader, sync.coupling.master_sync - leading.relocated,
                  leading.modulo ? leading.period : 0);
    else if (const MotionError why = place_cam(context, leader, from); why != MotionError::none)
        return why;
    const Cam table = cam(context);
    sync.stage = Stage::in_sync;
    if (sync.is_on_law(from, leader, table)) return MotionError::none;
    const double left = sync.distance(leader), start = sync.coupling.start_distance;
    if (!(left > 0)) return MotionError::sync_passed;
    sync.start = at;
    if (start == 0 || left <= start) return sync_error(approach(from, leader, table));
    sync.stage = Stage::waiting;
    const double rest = from.acceleration * std::abs(from.acceleration) / (2 * sync.dynamics.jerk);
    return sync_error(velocity_motion.begin(from, from.velocity + rest, sync.dynamics, at));
}

CurveFault Axis::approach(const MotionState& from, const MotionState& leader, const Cam& table) {
    return sync.approach(from, leader, table, modulo ? period : 0, foreseen());
}

/// How long a master that accelerates is taken to go on with it [s]: it may be at its velocity at
/// any time.
double Axis::foreseen() const {
    return 2 * seconds(scan_interval);
}

/// A relative cam begins, on its axis, at MasterOffset and, for the slave, where the slave is.
MotionError Axis::place_cam(const Context& context, const MotionState& leader,
                            const MotionState& from) {
    const Coupling& c = sync.coupling;
    const CamTableId id = CamTableId::of(c.cam);
    if (!is_instance<CamTable>(context, id.table)) return MotionError::no_cam;
    const Cam table = cam(context);
    if (table.points.empty()) return MotionError::no_cam;
    const double relocated_by = context.seen_instance<Axis>(c.master.axis).relocated;
    sync.cam_origin =
        c.master_offset + c.master_scaling * (id.master_absolute ? relocated_by : -leader.position);
    sync.cam_rise = c.slave_offset;
    if (!id.slave_absolute || c.start_mode == StartMode::relative)
        sync.cam_rise += from.position - sync.law_at(leader.position, table).y;
    sync.meet(leader, (c.master_sync - sync.cam_origin) / c.master_scaling,
              table.periodic ? table.length() / std::abs(c.master_scaling) : 0);
    sync.last_periods = table.periods(c.master_scaling * leader.position + sync.cam_origin);
    return MotionError::none;
}

Cam Axis::cam(const Context& context) const {
    if (sync.law != Law::cammed) return {};
    const CamTableId id = CamTableId::of(sync.coupling.cam);
    return context.instance<CamTable>(id.table).cam(id.periodic);
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
    if (phased.place != place || phased.ticket != job.ticket)
        end(context, phased, Progress::aborted);
    phased = {place, job.ticket, request, 0};
    tell(job, Progress::active);
}

// Each scan.

void Axis::look_at_shift(const Context& context) {
    if (!phased.exists()) return;
    sync.shift = sync.shifting.at(scan_time);
    if (!sync.shifting.has_ended(scan_time)) return;
    sync.shift = sync.shifting.plan.end;
    end(context, phased, Progress::done);
}

void Axis::follow(const Context& context) {
    look_at_shift(context);
    if (sync.law == Law::geared)
        follow_guide(context);
    else
        follow_law(context);
}

/// In gear it follows whatever its master has done since. What is measured never moves as foreseen:
/// then a transition may end with a scan.
void Axis::follow_guide(const Context& context) {
    const MotionState guide = sync.guide(master(context), led_by(context, sync.coupling.second));
    if (sync.stage == Stage::in_transition) {
        const double t = sync.start.until(scan_time);
        base = sync.transition.at(t);
        double left = sync.transition.plan.duration - t;
        if (left > Moment::same_scan && !sync.transition.foresees(guide, t)) {
            const MotionError why = sync_error(sync.get_onto(base, guide, {scan_time}));
            if (why != MotionError::none) return fail(context, {scan_time}, why);
            left = sync.transition.plan.duration -
                   (is_measured(sync.coupling) ? seconds(scan_interval) : 0);
        }
        if (left > Moment::same_scan) return;
        sync.offset = sync.transition.plan.end.position;
        reach(context);
        if (doing != Doing::following_axes || sync.stage != Stage::in_sync) return;
    }
    base = guide;
    base.position += sync.offset;
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
    if (sync.stage == Stage::waiting) {
        base = velocity_motion.at(scan_time);
        if (sync.distance(leader) > sync.coupling.start_distance) return;
        sync.start = {scan_time};
        const CurveFault fault = approach(base, leader, table);
        if (fault != CurveFault::none) return fail(context, {scan_time}, sync_error(fault));
        return tell(context, active, Progress::approaching);
    }
    if (sync.stage == Stage::approaching && sync.distance(leader) > 0) {
        base = sync.curve.at(leader.position).led_by(leader);
        return foresee(context, leader);
    }
    base = sync.law_at(leader.position, table).led_by(leader);
    if (sync.reached == 0 || !active.exists()) reach(context);
    if (sync.law == Law::cammed) count_periods(context, table, leader);
}

/// A master that moves otherwise than when the limits were checked, where its jerk does not count:
/// whether they are still kept.
void Axis::foresee(const Context& context, const MotionState& leader) {
    if (sync.sure != 0 && sync.transition.foresees(leader, sync.start.until(scan_time))) return;
    sync.start = {scan_time};
    const CurveFault fault =
        sync.foresee(sync.curve, leader, sync.limits(base.velocity), foreseen());
    if (fault != CurveFault::none) fail(context, {scan_time}, sync_error(fault));
}

/// EndOfProfile: the command sees by the number that a period has ended. What waits begins there.
void Axis::count_periods(const Context& context, const Cam& table, const MotionState& leader) {
    const Coupling& c = sync.coupling;
    const double periods = table.periods(c.master_scaling * leader.position + sync.cam_origin);
    if (periods == sync.last_periods) return;
    sync.last_periods = periods;
    Job& job = context.at<Job>(active.place);
    if (job.ticket == active.ticket) job.told_value += 1;
    tell(context, active, Progress::reached);
    if (queue.first != nowhere) begin_next(context, {scan_time});
}

}  // namespace lineshaft

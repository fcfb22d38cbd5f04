#include <algorithm>
#include <cmath>

#include "blocks/axis/axis.hpp"
#include "blocks/axis/cam_table.hpp"
#include "blocks/axis/written_cam.hpp"

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

/// In which period a cam begins, which is open at the seam of two until the master moves, and at
/// which of its ends one that is not periodic is over.
void find_end(SyncMotion& sync, const MotionState& leader, const Cam& table) {
    const double x = sync.coupling.master_scaling * leader.position + sync.cam_origin;
    sync.last_periods = sync.period_from(leader.position, sync.direction, table);
    const bool has_other =
        sync.period_from(leader.position, -sync.direction, table) != sync.last_periods;
    sync.period_is_open = leader.velocity == 0 && has_other ? 1 : 0;
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

/// From where a modulo axis is on its way to where it is in its turn, 0 to its period: at the seam
/// of two turns in the one that it runs into.
double to_its_turn(const Axis& leading, const MotionState& leader) {
    if (!leading.modulo) return 0;
    const double at = leader.position + leading.relocated, period = leading.period;
    const double within = within_period(at, period), slack = sum_rounding * (std::abs(at) + period);
    if (leader.velocity < 0 && within <= slack) return within + period - at;
    if (leader.velocity >= 0 && period - within <= slack) return within - period - at;
    return within - at;
}

/// A cam that is executed once moves with its place.
void move_place(SyncMotion& sync, const MotionState& leader, double way, const Cam& table) {
    const Coupling& c = sync.coupling;
    const double before = sync.law_at(leader.position, table).y;
    sync.sync_x += way;
    if (sync.law == Law::positioned || table.periodic) return;
    sync.cam_origin -= c.master_scaling * way;
    if (!CamTableId::of(c.cam).slave_absolute || c.start_mode == StartMode::relative)
        sync.cam_rise += before - sync.law_at(leader.position, table).y;
    find_end(sync, leader, table);
}

/// A place that the master has passed in its turn, or where it is, is met in the next one.
void meet_in_next_turn(SyncMotion& sync, const MotionState& leader, double turn, const Cam& table) {
    const double turns = std::floor(-sync.distance(leader) / turn) + 1;
    move_place(sync, leader, sync.direction * turn * turns, table);
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
    const bool is_there = sync.is_on_law(from, leader, table);
    if (is_there && c.start_distance == 0) return MotionError::none;
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
    if (!(left > 0)) return is_there ? MotionError::none : MotionError::sync_passed;
    if (c.start_distance == 0 || left <= c.start_distance)
        return approach(context, from, table, at);
    sync.stage = Stage::waiting;
    sync.start = at;
    const double rest = from.acceleration * std::abs(from.acceleration) / (2 * sync.dynamics.jerk);
    return sync_error(velocity_motion.begin(from, from.velocity + rest, sync.dynamics, at));
}

/// Which of the places that come again with the turns of its master a slave meets is open until the
/// master moves: one that stands takes the next in that direction. A master that is measured moves
/// to and fro by its noise, and has to pass a place first. Where the next is too near it is the one
/// behind.
MotionError Axis::turn_to_master(const Context& context, const MotionState& leader,
                                 const Cam& table) {
    const bool stands = base.velocity == 0 && base.acceleration == 0;
    if (sync.stage == Stage::approaching && !stands) return MotionError::none;
    const Axis& leading = context.seen_instance<Axis>(sync.coupling.master.axis);
    const double turn = turn_of(sync, table, leading.modulo ? leading.period : 0);
    const bool passes = sync.distance(leader) > turn + sync.coupling.start_distance;
    if (!(turn > 0) || (sync.coupling.is_measured() && !passes)) return MotionError::none;
    sync.direction = -sync.direction;
    if (sync.law == Law::positioned || table.periodic) sync.meet(leader, sync.sync_x, turn);
    if (!(sync.distance(leader) > 0)) meet_in_next_turn(sync, leader, turn, table);
    if (sync.stage == Stage::waiting) return MotionError::none;
    sync.led = leader;
    if (approach(context, base, table, {scan_time}) == MotionError::none) return MotionError::none;
    move_place(sync, leader, sync.direction * turn, table);
    return approach(context, base, table, {scan_time});
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
/// that is executed once ends at the other end than it is entered by; of a modulo axis it lies in
/// the turn that the axis is in.
MotionError Axis::place_cam(const Context& context, const MotionState& leader,
                            const MotionState& from) {
    const Coupling& c = sync.coupling;
    const CamTableId id = CamTableId::of(c.cam);
    const Cam table = begun_anew(WrittenCam::find(context, id));
    if (table.points.empty()) return MotionError::no_cam;
    const Axis& leading = context.seen_instance<Axis>(c.master.axis);
    const bool direct = c.start_mode == StartMode::direct;
    double absolute_from = leading.relocated;
    if (direct || !table.periodic) absolute_from += to_its_turn(leading, leader);
    sync.cam_origin = c.master_offset +
                      c.master_scaling * (id.master_absolute ? absolute_from : -leader.position);
    sync.cam_rise = c.slave_offset;
    if (direct)
        place_direct_cam(leader, from, table);
    else if (!id.slave_absolute || c.start_mode == StartMode::relative)
        sync.cam_rise += from.position - sync.law_at(leader.position, table).y;
    sync.meet(leader, (c.master_sync - sync.cam_origin) / c.master_scaling,
              table.periodic ? table.length() / std::abs(c.master_scaling) : 0);
    find_end(sync, leader, table);
    return MotionError::none;
}

/// Its origin is where the slave is, or the axis' own. It begins with its first period, and of a
/// modulo axis with the turn that the axis is in.
void Axis::place_direct_cam(const MotionState& leader, const MotionState& from, const Cam& table) {
    const Coupling& c = sync.coupling;
    const double x = c.master_scaling * leader.position + sync.cam_origin;
    if (!CamTableId::of(c.cam).slave_absolute) sync.cam_rise += from.position;
    if (table.periodic) sync.cam_rise -= c.slave_scaling * table.periods(x) * table.lift();
    const double y = sync.law_at(leader.position, table).y;
    if (modulo) sync.cam_rise += period * std::round((from.position - y) / period);
}

Cam Axis::cam(const Context& context) const {
    if (sync.law != Law::cammed) return {};
    return begun_anew(WrittenCam::followed(context, CamTableId::of(sync.coupling.cam)));
}

bool Axis::may_exchange_cam(const Request& request) const {
    return rules_of(request.rules).exchanges_cams && request.command == Command::cam_in &&
           doing == Doing::following_axes && sync.law == Law::cammed &&
           sync.stage == SyncMotion::Stage::in_sync;
}

/// Another cam in the place of the one that is followed. It begins with the period that the master
/// is in, or behind the end of a cam that has one, there with its end; or as an absolute one where
/// it is. False where there is no such cam.
bool Axis::exchange_cam(const Context& context, const Request& request) {
    const Coupling& c = sync.coupling;
    const CamTableId id = CamTableId::of(request.coupling.cam);
    const Cam before = cam(context), after = begun_anew(WrittenCam::find(context, id));
    if (before.points.empty() || after.points.empty()) return false;
    double x = c.master_scaling * sync.led.position + sync.cam_origin;
    const double runs = before.periodic ? sync.last_periods : x >= before.points.back().x ? 1 : 0;
    const double seam = before.begin() + runs * before.length();
    const double place = c.slave_scaling * (before.points.front().y + runs * before.lift());
    sync.coupling.cam = request.coupling.cam;
    if (!id.master_absolute) {
        sync.cam_origin += after.begin() - seam;
        x += after.begin() - seam;
    }
    const double periods = after.periodic ? after.periods(x) : 0;
    if (c.falls == 0)
        sync.cam_rise +=
            place - c.slave_scaling * (after.points.front().y + periods * after.lift());
    sync.enter_period(periods);
    sync.ends_at = sync.finished = 0;
    return true;
}

/// On a modulo axis the slave is where it began by whole turns, too.
Cam Axis::begun_anew(Cam table) const {
    const Coupling& c = sync.coupling;
    if (c.falls == 0 || table.points.empty()) return table;
    table.falls = table.lift();
    if (modulo && c.slave_scaling != 0)
        table.falls -=
            period * std::round(c.slave_scaling * table.lift() / period) / c.slave_scaling;
    return table;
}

void Axis::begin_phasing(const Context& context, Job& job) {
    const Request& request = job.request;
    const Dynamics d = dynamics_of(request);
    const std::int64_t place = context.place_of(job);
    const bool is_new = phased.place != place || phased.ticket != job.ticket;
    const double from = is_new ? sync.shift.position : phased.from;
    double to = request.position;
    if (request.command == Command::phasing_relative) to += from;
    if (request.halts != 0 && d.valid()) to = stopping_position(sync.shift, d);
    const PlanResult planned = d.valid() ? sync.shifting.begin(sync.shift, to, 0, d, {scan_time})
                                         : PlanResult::limit_not_positive;
    if (planned != PlanResult::ok) return tell(job, Progress::failed, sync_error(planned));
    if (is_new) {
        end(context, phased, Progress::aborted);
        phased = {place, job.ticket, request, 0, from};
    }
    phased.request = request;
    tell(job, Progress::active);
}

}  // namespace lineshaft

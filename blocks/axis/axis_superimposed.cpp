#include <algorithm>
#include <cmath>

#include "blocks/axis/axis.hpp"

namespace lineshaft {

bool is_superimposed(Command command) {
    return command == Command::move_superimposed || command == Command::halt_superimposed;
}

bool keeps_superimposed(const Request& request) {
    return rules_of(request.rules).keeps_superimposed && is_absolute(request.command) &&
           request.mode != BufferMode::aborting;
}

/// What the one before has covered stays; the new distance counts from there.
void Axis::begin_added(const Context& context, const Moment& at, Job& job) {
    const bool halts = job.request.command == Command::halt_superimposed;
    if (halts && !added.exists()) return tell(job, Progress::done);
    if (!halts && !active.exists() && !may_go(job.request.position))
        return tell(job, Progress::failed, MotionError::direction_not_enabled);
    const double covered = extra.position;
    const MotionError why =
        plan_added(context, at, job.request, covered, covered + job.request.position);
    if (why != MotionError::none) return tell(job, Progress::failed, why);
    end(context, added, Progress::aborted);
    added = {context.place_of(job), job.ticket, job.request, 0, extra.position};
    if (!halts) added_counted = 0;
    if (!active.exists()) goal = base.position + offset;
    state = *next_state(job.request.command, state);
    if (!active.exists() && state == AxisState::standstill) state = AxisState::discrete_motion;
    tell(job, Progress::active);
}

void Axis::change_added(const Context& context, const Moment& at, const Request& before) {
    const double to = added_goal + (added.request.position - before.position);
    if (plan_added(context, at, added.request, to, to) == MotionError::none)
        tell(context, added, Progress::active);
    else
        added.request = before;
}

/// With other factors.
void Axis::replan_added(const Context& context, const Moment& at) {
    if (!added.exists() || goes_by_way()) return;
    extra = added_motion.plan.at(added_motion.start.until(at.time) + at.later);
    plan_added(context, at, added.request, added_goal, added_goal);
}

/// What was on top so far is to end at `covered`, and what is from now on at `to`. Where it halts,
/// both are where it then stands.
MotionError Axis::plan_added(const Context& context, const Moment& at, const Request& request,
                             double covered, double to) {
    const Dynamics asked = asked_of(request);
    if (!asked.valid()) return MotionError::limit_not_positive;
    const bool by_way = request.process_velocity > 0;
    Dynamics d = by_way ? asked : dynamics_of(request);
    const bool halts = request.command == Command::halt_superimposed;
    const bool pauses = !halts && d.velocity == 0;
    if (d.velocity == 0) d.velocity = asked.velocity;
    const MotionState from = by_way ? added_over_time(request.process_velocity) : extra;
    const double stop = stopping_position(from, d);
    if (halts) covered = to = stop;
    PointMotion next;
    const PlanResult planned = next.begin(from, pauses ? stop : to, 0, d, at);
    if (planned != PlanResult::ok) return motion_error_of(planned);
    if (!may_add(next, by_way)) return MotionError::software_limit;
    added_motion = next;
    added_passed = 0;
    added_seen = beneath();
    added_beneath = base.velocity;
    added_paused = pauses ? 1 : 0;
    const double missing = added_goal - covered;
    added_goal = to;
    if (added_counted != 0) make_up_for(missing);
    const bool joins = queue.first != nowhere || added_counted != 0;
    if (joins && doing == Doing::moving_to_point) replan(context, at);
    return MotionError::none;
}

/// An absolute move that counted on this way on top has it before itself: its target stays.
void Axis::make_up_for(double missing) {
    const bool is_on_its_way = doing == Doing::moving_to_point || paused != 0;
    if (!is_on_its_way || !active.exists() || !is_absolute(active.request.command)) return;
    take_in(-missing);
    offset -= missing;
}

/// This much of what is on top belongs to the motion beneath.
void Axis::take_in(double way) {
    extra.position -= way;
    added.from -= way;
    added_motion.move(-way);
    added_goal -= way;
    added_before += way;
}

void Axis::look_at_added(std::int64_t now) {
    if (goes_by_way()) {
        const double way = std::abs(beneath() - added_seen);
        added_passed += way / added.request.process_velocity;
        added_passed = std::min(added_passed, added_motion.duration);
        added_seen = beneath();
        extra = added_by_way();
    } else {
        extra = added_motion.at(now);
    }
    added.covered = extra.position - added.from;
}

void Axis::end_added(const Context& context) {
    safe.as_planned = 0;
    extra = {.position = added_goal};
    added.covered = extra.position - added.from;
    const bool halts = halts_beneath();
    end(context, added, Progress::done);
    if (halts) end_done(context);
    if (!active.exists() && queue.first != nowhere) return begin_next(context, {scan_time});
    settle();
}

/// What is to stand does so beneath, while something on top still moves.
bool Axis::halts_beneath() const {
    return active.request.command == Command::halt && doing == Doing::holding &&
           base.velocity == 0 && added.exists() && !goes_by_way();
}

/// By the way of the motion beneath, as far as that takes at the velocity for which it is planned.
bool Axis::goes_by_way() const {
    return added.exists() && added.request.process_velocity > 0;
}

/// How far the motion beneath has come, whatever it has taken in and however its place is called.
double Axis::beneath() const {
    return base.position + offset - added_before - relocated;
}

MotionState Axis::added_by_way() const {
    const double planned_for = added.request.process_velocity;
    const double sign = base.velocity < 0 ? -1 : 1;
    const MotionState s = added_motion.plan.at(added_passed);
    const double rate = sign * base.velocity / planned_for;
    const double change = sign * base.acceleration / planned_for;
    return {s.position, s.velocity * rate, s.acceleration * rate * rate + s.velocity * change,
            s.jerk * rate * rate * rate + 3 * s.acceleration * rate * change +
                s.velocity * sign * base.jerk / planned_for};
}

/// What is on top now, as if the motion beneath had this velocity.
MotionState Axis::added_over_time(double process_velocity) const {
    if (goes_by_way()) {
        MotionState s = added_motion.plan.at(added_passed);
        const double rate = process_velocity / added.request.process_velocity;
        return {s.position, s.velocity * rate, s.acceleration * rate * rate};
    }
    const double rate = std::abs(base.velocity) / process_velocity;
    return {extra.position, rate > 0 ? extra.velocity / rate : 0};
}

/// What goes by way ends with its plan, or by what it is to be aborted; else it waits for the
/// motion beneath.
void Axis::watch_beneath(const Context& context) {
    if (added_passed >= added_motion.duration) return end_added(context);
    const bool reverses = added_beneath * base.velocity < 0;
    if (base.velocity != 0) added_beneath = base.velocity;
    const bool follows = doing != Doing::holding && doing != Doing::moving_to_point &&
                         doing != Doing::following_velocity;
    const bool ended = doing == Doing::holding && base.velocity == 0 && !is_held();
    const AbortedBy by = added.request.aborted_by;
    const bool stands = ended || reverses || (follows && base.velocity == 0);
    if (by == AbortedBy::standstill ? stands : by == AbortedBy::end && ended) stop_added(context);
    settle();
}

/// The rest of it is dropped, while the motion beneath stands.
void Axis::stop_added(const Context& context) {
    safe.as_planned = 0;
    const double missing = added_goal - extra.position;
    added_goal = extra.position;
    extra = {.position = added_goal};
    added.covered = extra.position - added.from;
    end(context, added, Progress::aborted);
    if (added_counted != 0) make_up_for(missing);
    const bool joins = queue.first != nowhere || added_counted != 0;
    if (joins && doing == Doing::moving_to_point) replan(context, {scan_time});
}

/// Whether what is on top goes on when a command begins.
bool Axis::keeps_added(const Request& request) const {
    if (request.command == Command::home) return false;
    if (request.mode != BufferMode::aborting) return true;
    return goes_by_way() && state != AxisState::synchronized_motion &&
           !is_synchronous(request.command);
}

/// With what it has covered in the motion beneath.
void Axis::clear_added() {
    extra = {};
    added_goal = added_before = 0;
    added_counted = added_paused = 0;
}

}  // namespace lineshaft

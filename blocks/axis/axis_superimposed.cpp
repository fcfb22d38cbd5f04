#include "blocks/axis/axis.hpp"

namespace lineshaft {

bool is_superimposed(Command command) {
    return command == Command::move_superimposed || command == Command::halt_superimposed;
}

bool keeps_superimposed(const Request& request) {
    return rules_of(request.rules).keeps_superimposed && is_absolute(request.command) &&
           request.mode != BufferMode::aborting;
}

/// Of the one before stays what it has covered; the new distance counts from there.
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
    if (!added.exists()) return;
    extra = added_motion.plan.at(added_motion.start.until(at.time) + at.later);
    plan_added(context, at, added.request, added_goal, added_goal);
}

/// What was on top so far is to end at `covered`, and what is from now on at `to`. Where it halts,
/// both are where it then stands.
MotionError Axis::plan_added(const Context& context, const Moment& at, const Request& request,
                             double covered, double to) {
    const Dynamics asked = asked_of(request);
    if (!asked.valid()) return MotionError::limit_not_positive;
    Dynamics d = dynamics_of(request);
    const bool halts = request.command == Command::halt_superimposed;
    const bool pauses = !halts && d.velocity == 0;
    if (d.velocity == 0) d.velocity = asked.velocity;
    const double stop = stopping_position(extra, d);
    if (halts) covered = to = stop;
    PointMotion next;
    const PlanResult planned = next.begin(extra, pauses ? stop : to, 0, d, at);
    if (planned != PlanResult::ok) return motion_error_of(planned);
    if (!may_add(next)) return MotionError::software_limit;
    added_motion = next;
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
    extra = added_motion.at(now);
    added.covered = extra.position - added.from;
}

void Axis::end_added(const Context& context) {
    safe.as_planned = 0;
    extra = {.position = added_goal};
    added.covered = extra.position - added.from;
    end(context, added, Progress::done);
    settle();
}

/// With what it has covered in the motion beneath.
void Axis::clear_added() {
    extra = {};
    added_goal = added_before = 0;
    added_counted = added_paused = 0;
}

}  // namespace lineshaft

#include <algorithm>
#include <cmath>

#include "blocks/axis/axis.hpp"

namespace lineshaft {

namespace {

bool ends_standing(Command command) {
    using enum Command;
    return command == move_absolute || command == move_relative || command == move_additive;
}

/// The one of two velocities that the mode wants where they meet.
double wanted_velocity(BufferMode mode, double previous, double next) {
    switch (mode) {
        case BufferMode::blending_low:
            return std::min(previous, next);
        case BufferMode::blending_high:
            return std::max(previous, next);
        case BufferMode::blending_next:
            return next;
        default:
            return previous;
    }
}

/// TwinCAT's halts that begin where the move before was to end.
bool halts_behind(const Request& request) {
    return request.command == Command::halt && rules_of(request.rules).halts_where_due &&
           (request.mode == BufferMode::blending_previous ||
            request.mode == BufferMode::blending_high);
}

constexpr double slightly_less = 1 - 1e-9;  ///< for rounding, where a plan just goes

/// 1 or -1, or 0: nowhere.
double sign_towards(double way) {
    return way < 0 ? -1 : way > 0 ? 1 : 0;
}

/// How much of the way between two positions a plan that does not turn round may use: the rest is
/// for rounding.
double room_between(double from, double to) {
    const double way = std::abs(to - from);
    return std::max(0.0, way - 1e-13 * (std::abs(from) + std::abs(to) + way));
}

}  // namespace

/// Where the command goes from the end of one that goes in a direction (its sign; 0: it stands).
void Axis::foresee_way(const Request& request, double start, double direction, Ahead& to) const {
    to.goal = start;
    to.direction = 0;
    if (request.command == Command::move_velocity) {
        double v = request.velocity;
        if (request.direction == MoveDirection::negative) v = -v;
        if (request.direction == MoveDirection::current && direction != 0)
            v = std::copysign(v, direction);
        to.direction = sign_towards(v);
    } else if (halts_behind(request)) {
        to.direction = direction;
    } else if (ends_standing(request.command) || is_continuous(request.command)) {
        Start there;
        there.state.position = there.origin = start;
        there.taken = added_goal;
        to.goal = target_of(request, there);
        to.direction = sign_towards(to.goal - start);
    }
}

/// With which velocities the command can begin, and where its stretch ends, by what is known of the
/// one behind it. `before` is the one before it, which goes in a direction.
void Axis::foresee_speeds(const Request& request, const Request& before, double start,
                          double direction, const Ahead* behind, Ahead& to) const {
    const Dynamics own = dynamics_of(request), previous = dynamics_of(before);
    to.passes = request.mode >= BufferMode::blending_low && ends_standing(before.command) &&
                        to.direction * direction > 0 && own.valid()
                    ? 1
                    : 0;
    const bool on_and_on = request.command == Command::move_velocity || halts_behind(request);
    to.joins = to.passes != 0 && !on_and_on && own == previous ? 1 : 0;
    to.stretch_end = to.goal;
    to.exit = to.entry = {};
    if (to.direction == 0 || !own.valid()) return;
    if (is_continuous(request.command)) {
        const double v = request.end_velocity * factors.velocity;
        to.exit = {v, v};
        if (request.end_velocity < 0) to.passes = to.joins = 0;
    } else if (behind && behind->joins != 0) {
        to.exit = behind->exit;
        to.stretch_end = behind->stretch_end;
    } else if (behind && behind->passes != 0) {
        to.exit = behind->entry;
    }
    if (to.passes == 0) return;
    const double v = request.command == Command::move_velocity
                         ? std::abs(request.velocity) * factors.velocity
                         : own.velocity;
    const double wanted = halts_behind(request)
                              ? previous.velocity
                              : wanted_velocity(request.mode, previous.velocity, v);
    to.entry =
        on_and_on ? Speeds{0, wanted} : entries(room_between(start, to.stretch_end), to.exit, own);
    to.entry.greatest = std::min(to.entry.greatest, wanted);
    if (to.entry.exist() && to.entry.greatest > 0) return;
    to.entry = {};
    if (to.joins == 0) to.passes = 0;
}

/// What is known of the command before a job in the queue.
Axis::Before Axis::before(const Context& context, const Job& job) const {
    if (job.previous == nowhere) {
        const bool goes = doing == Doing::moving_to_point || paused != 0;
        const double direction = goes ? sign_towards(goal - base.position - offset) : 0;
        return {active.request, goal + added_goal, direction};
    }
    const Job& previous = context.at<Job>(job.previous);
    return {previous.request, previous.ahead.goal, previous.ahead.direction};
}

/// Behind what waits last, or is at work.
bool Axis::may_blend(const Context& context, const Request& request) const {
    if (request.mode < BufferMode::blending_low) return true;
    const bool is_first = queue.last == nowhere && !active.exists();
    if (is_first || !rules_of(request.rules).blends_moves_only) return true;
    const Request& before =
        queue.last == nowhere ? active.request : context.at<Job>(queue.last).request;
    return ends_standing(before.command);
}

/// Whether anything has changed of what those before it need.
bool Axis::look_back(const Context& context, Job& job) const {
    const auto [request, start, direction] = before(context, job);
    const Ahead* behind = job.next == nowhere ? nullptr : &context.at<Job>(job.next).ahead;
    const Ahead old = job.ahead;
    foresee_speeds(job.request, request, start, direction, behind, job.ahead);
    return old != job.ahead;
}

/// All that waits, after a change of what is at work.
void Axis::look_ahead(const Context& context) {
    for (std::int64_t place = queue.first; place != nowhere;) {
        Job& job = context.at<Job>(place);
        const auto [request, start, direction] = before(context, job);
        foresee_way(job.request, start, direction, job.ahead);
        place = job.next;
    }
    for (std::int64_t place = queue.last; place != nowhere;) {
        Job& job = context.at<Job>(place);
        look_back(context, job);
        place = job.previous;
    }
}

/// The last of the queue, and those before it that hang on it. Whether it changes what is at work.
bool Axis::look_ahead(const Context& context, Job& last) {
    const auto [request, start, direction] = before(context, last);
    foresee_way(last.request, start, direction, last.ahead);
    look_back(context, last);
    for (const Job* job = &last; job->previous != nowhere;) {
        Job& earlier = context.at<Job>(job->previous);
        if (!look_back(context, earlier)) return false;
        job = &earlier;
    }
    return true;
}

/// What `active` is about to do, seen along its direction.
struct Axis::Junction {
    Start from;
    Dynamics dynamics;
    double direction = 1;
    double end = 0;  ///< of the stretch, where point_motion has it
};

/// To the end of the stretch with a velocity: within the command's own as long as the way allows.
bool Axis::plan_to_junction(const Junction& junction, double end_velocity, PointMotion& motion,
                            Leg& rest, const Moment& at) const {
    const auto& [from, dynamics, direction, stretch_end] = junction;
    const double end = direction * end_velocity;
    rest = {};
    if (end_velocity > dynamics.velocity) {
        const double cruise = direction * dynamics.velocity;
        const double ahead = ramp_way(cruise, end, dynamics);
        const bool planned =
            motion.begin(from.state, stretch_end - ahead, cruise, dynamics, at) == PlanResult::ok;
        if (planned && !motion.turns(direction)) {
            rest = {1, stretch_end, end, dynamics};
            return true;
        }
    }
    return motion.begin(from.state, stretch_end, end, dynamics, at) == PlanResult::ok &&
           !motion.turns(direction);
}

/// The velocities from which the axis can brake inside its limits; empty: there is none.
std::optional<Speeds> Axis::brakeable(const Speeds& exit, const Junction& junction) const {
    if (!software_limits) return exit;
    const auto can = [&](double v) {
        return can_brake({junction.end + added_goal, junction.direction * v});
    };
    if (can(exit.greatest)) return exit;
    if (!can(exit.least)) return {};
    double low = exit.least, high = exit.greatest;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (can(middle) ? low : high) = middle;
    }
    return Speeds{exit.least, low};
}

/// The end of `active` is passed with the velocity that the mode of the next command wants, or the
/// greatest below it with which nothing in the queue has to turn round; on the stretch that it
/// begins, as the whole of it asks for. Where there is none it stands at its end, as planned.
void Axis::blend(const Context& context, const Moment& at) {
    if (doing != Doing::moving_to_point || !ends_standing(active.request.command)) return;
    Job& next = front(context);
    look_back(context, next);
    if (next.ahead.passes == 0) return;
    Junction junction{start_again(), dynamics_of(active.request)};
    junction.direction = next.ahead.direction;
    const bool joins = next.ahead.joins != 0;
    junction.end = joins ? next.ahead.stretch_end - added_goal : goal;
    const auto exit = brakeable(joins ? next.ahead.exit : next.ahead.entry, junction);
    if (!exit) return;
    MotionState along = junction.from.state;
    along.velocity *= junction.direction;
    along.acceleration *= junction.direction;
    const auto v =
        greatest_exit(along, room_between(along.position, junction.end), *exit, junction.dynamics);
    PointMotion motion;
    Leg rest;
    if (!v || (*v == 0 && !joins)) return;
    if (!plan_to_junction(junction, *v, motion, rest, at) &&
        !plan_to_junction(junction, std::max(exit->least, *v * slightly_less), motion, rest, at))
        return;
    point_motion = motion;
    point_motion.end_at(goal, junction.direction);
    leg = rest;
    leg.passed = goal;
    base = junction.from.state;
    offset = 0;
}

/// Whether the stretch that the move before has planned is the way of the command that comes next.
bool Axis::leads_along(const Stretch& stretch, const Job& next) const {
    if (next.ahead.joins == 0) return false;
    const Start from = start_of(next.request, false);
    double to = target_of(next.request, from);
    const double end =
        stretch.leg.exists != 0 ? stretch.leg.goal : stretch.motion.plan.end.position;
    return from.taken == 0 && may_aim_at(to, from) && to == next.ahead.goal &&
           (end - to) * next.ahead.direction >= 0;
}

void Axis::go_along(const Stretch& stretch, const Job& next, const Start& from) {
    const double direction = next.ahead.direction;
    goal = next.ahead.goal;
    point_motion = stretch.motion;
    point_motion.end_at(goal, direction);
    doing = Doing::moving_to_point;
    leg = stretch.leg;
    leg.passed = goal;
    lasting = is_continuous(next.request.command) ? direction * next.request.end_velocity : 0;
    origin = from.origin;
    base = from.state;
    paused = 0;
    offset = 0;
}

/// What is at work, without what it counted on in the queue, and with what is there now.
void Axis::blend_anew(const Context& context, const Moment& at) {
    withdrawn = 0;
    if (!active.exists()) return;
    if (doing == Doing::moving_to_point && ends_standing(active.request.command))
        replan(context, at);
    else
        look_ahead(context);
}

}  // namespace lineshaft

#include "blocks/path/path_leg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks/profile/seven_segment.hpp"

namespace lineshaft {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// From where the motion begins.
struct Departure {
    MotionState from;
    double base = 0, factor = 1;
};

/// Stretches up to one of them: the least of their boxes, and the greatest velocity in them.
struct Span {
    std::uint64_t goal = 0;
    PathLimit least;
    double fastest = 0;

    void extend(ConstPathStretches stretches, std::uint64_t to) {
        for (; goal < to; ++goal) {
            const PathLimit& box = stretches[goal + 1].box;
            least = least_of(least, box);
            fastest = std::max(fastest, box.velocity);
        }
    }
};

/// The velocity nearest to `wanted` that is reached within `room`; below 0 where there is none.
double reached_velocity(const MotionState& from, double room, double wanted, const PathLimit& box) {
    if (way_to(from, wanted, box) <= room) return wanted;
    const double a = from.acceleration;
    double reached = std::max(0.0, from.velocity + a * std::abs(a) / (2 * box.jerk));
    double missed = wanted;
    if (a != 0 && !(way_to(from, reached, box) <= room)) return -1;
    if (a == 0) {
        SevenSegmentPlan direct;
        const double V = std::max(from.velocity, wanted);
        if (plan({from.velocity, wanted, V, box.acceleration, box.jerk, room}, direct) !=
            PlanResult::ok)
            return -1;
        const double found = direct.end.velocity, off = reached - found;
        for (double less = 0x1p-46; less < 1; less *= 64)
            if (const double tried = found + less * off; way_to(from, tried, box) <= room)
                return tried;
        missed = found;
    }
    for (int step = 0; step < 52; ++step) {
        const double middle = 0.5 * (reached + missed);
        (way_to(from, middle, box) <= room ? reached : missed) = middle;
    }
    return reached;
}

constexpr double box_rounding = 1e-10;

/// A part of a phase within one stretch.
bool is_in_box(const MotionState& start, double duration, const PathLimit& box) {
    const MotionState end = start.after(duration);
    const double V = box.velocity * (1 + box_rounding);
    const double A = box.acceleration * (1 + box_rounding);
    if (std::abs(start.jerk) > box.jerk * (1 + box_rounding) || std::abs(start.acceleration) > A ||
        std::abs(end.acceleration) > A)
        return false;
    double least = std::min(start.velocity, end.velocity);
    double most = std::max(start.velocity, end.velocity);
    if (start.acceleration * end.acceleration < 0) {
        const double turn = start.after(-start.acceleration / start.jerk).velocity;
        least = std::min(least, turn);
        most = std::max(most, turn);
    }
    return most <= V && least >= -box_rounding * box.velocity;
}

/// A phase within the boxes of the stretches that it lies on.
class PhaseInBoxes {
  public:
    explicit PhaseInBoxes(const MotionPlan::Phase& phase)
        : start(phase.start), end(start.after(phase.duration)), duration(phase.duration) {
        acceleration = std::max(std::abs(start.acceleration), std::abs(end.acceleration));
        least = std::min(start.velocity, end.velocity);
        most = std::max(start.velocity, end.velocity);
        if (!(start.acceleration * end.acceleration < 0)) return;
        turns = true;
        const double turn = start.after(-start.acceleration / start.jerk).velocity;
        least = std::min(least, turn);
        most = std::max(most, turn);
    }

    double end_position() const { return end.position; }

    /// The part from one place to another, which may begin before it.
    bool keeps(double from, double to, const PathLimit& box) const {
        return surely_keeps(from, to, box) || exactly_keeps(from, to, box);
    }

  private:
    MotionState start, end;
    double duration, acceleration, least, most;
    bool turns = false;

    /// Where the acceleration does not change its sign the velocity is greatest at that end of the
    /// part that is further from the slow end of the phase.
    bool surely_keeps(double from, double to, const PathLimit& box) const {
        if (std::abs(start.jerk) > box.jerk || acceleration > box.acceleration || least < 0)
            return false;
        if (most <= box.velocity) return true;
        if (turns) return false;
        const bool rises = start.velocity < end.velocity;
        const MotionState& slow = rises ? start : end;
        const double jerk = rises ? start.jerk : -start.jerk;
        const double a = rises ? slow.acceleration : -slow.acceleration;
        const double way = rises ? to - start.position : end.position - from;
        return velocity_at(slow.velocity, a, jerk, std::max(way, 0.0)) <= box.velocity;
    }

    /// No less than it is: the way is convex in the time, so that from a time that is too long
    /// each of Newton's steps leads to another.
    double velocity_at(double v, double a, double jerk, double way) const {
        constexpr int steps = 3;
        double t = std::min(way / v, duration);
        for (int step = 0; step < steps; ++step) {
            const double square = 0.5 * jerk * t * t;
            t = (way + t * (0.5 * a * t + (2.0 / 3) * square)) / (v + a * t + square);
        }
        return v + t * (a + 0.5 * jerk * t);
    }

    bool exactly_keeps(double from, double to, const PathLimit& box) const {
        const double before = time_at(from);
        const double after = to < end.position ? time_at(to) : duration;
        return is_in_box(start.after(before), after - before, box);
    }

    double time_at(double place) const {
        const double way = place - start.position;
        return way > 0 ? time_at_way(start, duration, way) : 0;
    }
};

/// Whatever it was planned with: each of its states is in the box of the stretch that it lies in,
/// and it passes no stop.
bool keeps_boxes(ConstPathStretches stretches, const Departure& departure, std::uint64_t goal,
                 const MotionPlan& plan) {
    if (stretches.passes_stop(goal)) return false;
    std::uint64_t k = stretches.first;
    for (std::size_t i = 0; i < plan.count; ++i) {
        const PhaseInBoxes phase(plan.phases[i]);
        double from = plan.phases[i].start.position;
        for (; k < goal && departure.base + phase.end_position() > stretches[k].end; ++k) {
            const double to = stretches[k].end - departure.base;
            if (!phase.keeps(from, to, stretches[k].box)) return false;
            from = to;
        }
        if (!phase.keeps(from, phase.end_position(), stretches[k].box)) return false;
    }
    return true;
}

/// It goes on with the velocity that it ends with.
bool is_cruise(const MotionState& from, double velocity, const Goal& to) {
    return from.acceleration == 0 && from.velocity == velocity && to.velocity == velocity;
}

void take_cruise(const Goal& to, MotionPlan& out) {
    out.count = 1;
    out.duration = to.position / to.velocity;
    out.missed = 0;
    out.haste = MotionPlan::spread / out.duration;
    out.end = {to.position, to.velocity, 0, 0};
    out.phases[0] = {0, out.duration, {0, to.velocity, 0, 0}};
}

/// A copy without the phases that are not there.
void take_plan(const MotionPlan& from, MotionPlan& out) {
    out.count = from.count;
    out.duration = from.duration;
    out.missed = from.missed;
    out.haste = from.haste;
    out.end = from.end;
    std::copy_n(from.phases.begin(), from.count, out.phases.begin());
}

/// In the least of the boxes but with this velocity.
bool plan_with(ConstPathStretches stretches, const Departure& departure, const Span& span,
               double velocity, const Goal& to, MotionPlan& out) {
    if (!(velocity > 0)) return false;
    if (is_cruise(departure.from, velocity, to)) {
        take_cruise(to, out);
        return keeps_boxes(stretches, departure, span.goal, out);
    }
    MotionLimits limits;
    return limits.set(velocity, -velocity, span.least.acceleration, span.least.acceleration,
                      span.least.jerk) == PlanResult::ok &&
           plan(limits, departure.from, to, out, {Entry::gentle, 1024}) == PlanResult::ok &&
           keeps_boxes(stretches, departure, span.goal, out);
}

/// To a place in the last stretch of the span, and a velocity there that is `exit` at most. Where
/// the motion ends as fast as the last box allows it is nowhere faster in it.
bool plan_to(ConstPathStretches stretches, const Departure& departure, const Span& span, double end,
             double exit, MotionPlan& out) {
    const auto& [from, base, factor] = departure;
    const double room = end - base;
    if (!(room > 0)) return false;
    const double wanted = std::min(exit, factor * stretches[span.goal].joint);
    const double velocity = reached_velocity(from, room, wanted, span.least);
    if (velocity < 0 || velocity > exit) return false;
    const double now =
        from.velocity + from.acceleration * std::abs(from.acceleration) / (2 * span.least.jerk);
    const double box = stretches[span.goal].box.velocity,
                 top = velocity < box ? infinite : velocity;
    double before = -1;
    for (const double V :
         {factor * span.fastest, factor * span.least.velocity, now, span.fastest}) {
        const double most = std::max(std::min(V, top), velocity);
        if (most != before && plan_with(stretches, departure, span, most, {room, velocity}, out))
            return true;
        before = most;
    }
    return false;
}

bool plan_to(ConstPathStretches stretches, const Departure& departure, const Span& span,
             MotionPlan& out) {
    return plan_to(stretches, departure, span, stretches[span.goal].end, stretches.exit(span.goal),
                   out);
}

bool plan_halt(ConstPathStretches stretches, const Departure& departure, Span span, PathLeg& out) {
    const auto& [from, base, factor] = departure;
    MotionPlan motion;
    for (;;) {
        const double way = way_to(from, 0, span.least);
        const double end = stretches[span.goal].end;
        if (base + way <= end) {
            if (!plan_with(stretches, departure, span, span.fastest, {way, 0}, motion))
                return false;
            out.take(motion, base, base + way, span.goal);
            return true;
        }
        if (!(way < infinite) || stretches.is_last(span.goal)) return false;
        span.extend(stretches, span.goal + 1);
    }
}

/// The motion that would follow one to a joint, to where the stretch behind it brakes; or `enough`
/// where it lasts longer [s].
double duration_of_next(ConstPathStretches stretches, std::uint64_t joint, double velocity,
                        double factor, double enough) {
    const PathStretch& next = stretches[joint + 1];
    const PathStretch& goal = stretches[next.target];
    const double exit = std::min(stretches.exit(next.target), factor * goal.joint);
    const double V = std::max({factor * next.box.velocity, velocity, exit});
    const double way = goal.end - next.begin;
    if (way >= enough * V) return enough;
    SevenSegmentPlan ramp;
    const SevenSegment problem{velocity, exit, V, next.span.acceleration, next.span.jerk, way};
    return plan(problem, ramp) == PlanResult::ok ? ramp.duration : infinite;
}

/// No acceleration is wanted at its end: it is as fast there as the joint itself allows.
bool ends_well(ConstPathStretches stretches, const Span& span, const MotionPlan& plan,
               double factor) {
    constexpr double rounding = 1e-8;
    return stretches.is_bound_by_joint(span.goal, factor) &&
           plan.end.velocity >= factor * stretches[span.goal].joint * (1 - rounding);
}

/// Further and further while that is sooner than to come to acceleration 0 at the joint.
void extend(ConstPathStretches stretches, const Departure& departure, Span& span,
            MotionPlan& best) {
    while (!stretches.is_last(span.goal) && !ends_well(stretches, span, best, departure.factor)) {
        Span longer = span;
        longer.extend(stretches, stretches[span.goal + 1].target);
        MotionPlan further;
        if (!plan_to(stretches, departure, longer, further)) return;
        const double more = further.duration - best.duration;
        if (more > duration_of_next(stretches, span.goal, best.end.velocity,
                                    std::max(departure.factor, 0x1p-20), more))
            return;
        take_plan(further, best);
        span = longer;
    }
}

/// When the motion leaves the one that it would be if the path went on further: where it begins to
/// come down to its end.
double ripe_at(const MotionPlan& plan) {
    std::size_t i = plan.count;
    const auto comes_down = [&](const MotionPlan::Phase& phase) {
        return phase.start.acceleration < 0 || phase.start.jerk < 0;
    };
    while (i > 0 && comes_down(plan.phases[i - 1])) --i;
    return i < plan.count ? plan.phases[i].begin : plan.duration;
}

}  // namespace

double way_to(const MotionState& from, double velocity, const PathLimit& box) {
    VelocityRamp ramp;
    if (ramp.plan(from.velocity, from.acceleration, velocity, box.acceleration, box.jerk) !=
        PlanResult::ok) {
        return infinite;
    }
    return ramp.end.position;
}

void PathLeg::stand(double place, std::uint64_t number) {
    plan.count = 0;
    plan.duration = plan.missed = plan.haste = 0;
    plan.end = {};
    course.clear();
    base = end = place;
    goal = number;
    ripe = 0;
}

void PathLeg::take(const MotionPlan& motion, double from, double to, std::uint64_t stretch) {
    take_plan(motion, plan);
    course.clear();
    base = from;
    end = to;
    goal = stretch;
    ripe = infinite;
}

double PathLeg::time_at(double way) const {
    const double lasts = duration();
    double t = 0;
    if (course.count > 0) {
        t = course.time_at(way);
    } else {
        std::size_t i = 0;
        while (i + 1 < plan.count && plan.phases[i + 1].start.position <= way) ++i;
        const MotionPlan::Phase& phase = plan.phases[i];
        const double left = way - phase.start.position;
        t = phase.begin + (left > 0 ? time_at_way(phase.start, phase.duration, left) : 0);
    }
    for (double later = 0x1p-52 * lasts; t < lasts && at(t).position < way; later *= 2) t += later;
    return std::min(t, lasts);
}

bool plan_leg(ConstPathStretches stretches, const MotionState& from, double base, double factor,
              const PathLimit& halt, PathLeg& out) {
    const PathStretch& first = stretches[stretches.first];
    const Departure departure{from, base, factor};
    Span span{stretches.first, first.box, first.box.velocity};
    Span gentle = span;
    gentle.least = least_of(span.least, halt);
    if (factor == 0 && (plan_halt(stretches, departure, gentle, out) ||
                        plan_halt(stretches, departure, span, out)))
        return true;
    MotionPlan motion;
    bool found = plan_to(stretches, departure, span, motion);
    if (!found) {
        span.extend(stretches, first.target);
        found = plan_to(stretches, departure, span, motion);
    }
    if (!found) {
        if (!plan_to(stretches, departure, span, first.ramp_end, first.ramp_exit, motion))
            return false;
        out.take(motion, base, first.ramp_end, first.target);
        return true;
    }
    if (factor > 0) extend(stretches, departure, span, motion);
    out.take(motion, base, stretches[span.goal].end, span.goal);
    if (factor > 0 && !ends_well(stretches, span, motion, factor)) out.ripe = ripe_at(motion);
    return true;
}

}  // namespace lineshaft

#include "blocks/path/path_stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks/profile/seven_segment.hpp"

namespace lineshaft {

namespace {

/// A ramp seen from its end backwards, where it is one upwards.
struct BackwardRamp {
    SevenSegmentPlan plan;
    double entry = 0;  ///< at its start [u/s]

    /// How far before its end it has a velocity, which grows with the way; infinite where it is
    /// nowhere as fast [u].
    double way_before_end(double velocity) const {
        std::size_t i = 0;
        while (i < 2 && !(plan.start[i + 1].velocity > velocity)) ++i;
        const MotionState &from = plan.start[i], &to = plan.start[i + 1];
        if (velocity >= to.velocity) return std::numeric_limits<double>::infinity();
        const double risen = velocity - from.velocity, rises = to.velocity - velocity;
        if (!(risen > 0)) return from.position;
        if (i == 0) return from.after(std::sqrt(2 * risen / from.jerk)).position;
        if (i == 1) return from.after(risen / from.acceleration).position;
        return from.after(plan.T[2] - std::sqrt(2 * rises / -from.jerk)).position;
    }

    /// From here on, counted from its end, it comes down as any ramp from a greater velocity.
    double settled_way() const { return plan.start[2].position; }
};

/// A little less than what is reached: what rounds there must not decide whether a ramp has room.
bool plan_back(double exit, double V, const PathLimit& box, double length, BackwardRamp& out) {
    const SevenSegment problem{exit, V, V, box.acceleration, box.jerk, length};
    if (plan(problem, out.plan) != PlanResult::ok) return false;
    const bool has_room = out.plan.reaches_Ve && out.plan.T[3] * V > 1e-9 * length;
    out.entry = has_room ? V : out.plan.end.velocity * (1 - 1e-9);
    return true;
}

/// It passes no joint faster than that allows, up to where it is as slow as the ramp before was.
bool passes_joints(PathStretches stretches, std::uint64_t k, const BackwardRamp& ramp) {
    const std::uint64_t target = stretches[k + 1].target;
    const double end = stretches[k + 1].ramp_end;
    for (std::uint64_t i = k; i < target; ++i) {
        const PathStretch& s = stretches[i];
        if (s.joint < ramp.entry && !(end - s.end <= ramp.way_before_end(s.joint))) return false;
        if (s.end >= stretches[k + 1].settled) break;
    }
    return true;
}

void take(PathStretch& s, const BackwardRamp& ramp, std::uint64_t target, const PathLimit& span,
          double end, double exit) {
    s.ramp_end = end;
    s.ramp_exit = exit;
    s.entry = ramp.entry;
    s.target = target;
    s.span = span;
    s.settled = end - ramp.settled_way();
}

/// No ramp to its own end begins faster: it takes no longer than at the velocity there.
double greatest_entry(const PathStretch& s, double exit) {
    const double V = s.box.velocity, lasts = (s.end - s.begin) / exit;
    return exit > 0 ? std::min(V, exit + 0.5 * s.box.jerk * lasts * lasts) : V;
}

/// The better one of a ramp to its own end and one to where the next stretch brakes.
void find_entry(PathStretches stretches, std::uint64_t k) {
    PathStretch& s = stretches[k];
    const double V = s.box.velocity, exit = std::min(stretches.exit(k), V);
    s.target = k;
    s.span = s.box;
    s.settled = s.ramp_end = s.end;
    if (exit == V) {
        s.entry = s.ramp_exit = V;
        return;
    }
    BackwardRamp ramp;
    s.entry = s.ramp_exit = 0;
    if (!stretches.is_last(k) && !stretches.is_bound_by_joint(k)) {
        const PathStretch& next = stretches[k + 1];
        const PathLimit span = least_of(s.box, next.span);
        if (next.ramp_exit <= V &&
            plan_back(next.ramp_exit, V, span, next.ramp_end - s.begin, ramp) &&
            passes_joints(stretches, k, ramp))
            take(s, ramp, next.target, span, next.ramp_end, next.ramp_exit);
    }
    if (s.entry <= greatest_entry(s, exit) && plan_back(exit, V, s.box, s.end - s.begin, ramp) &&
        ramp.entry >= s.entry)
        take(s, ramp, k, s.box, s.end, exit);
}

/// The velocity that the leg under way, and the ramps behind it, come to a stretch with; 0 where
/// none of them ends there.
double velocity_needed(PathStretches stretches, const PathReliance& relied, std::uint64_t k) {
    double velocity = relied.velocity;
    std::uint64_t next = relied.stretch;
    while (next < k && velocity > 0) {
        velocity = stretches[next].ramp_exit;
        next = stretches[next].target + 1;
    }
    return next == k ? velocity : 0;
}

}  // namespace

void look_back(PathStretches stretches, std::uint64_t changed, const PathReliance& relied) {
    for (std::uint64_t k = stretches.count; k-- > stretches.first;) {
        const bool may_end = k > stretches.first && k <= changed;
        const bool was_bound = may_end && stretches.is_bound_by_joint(k - 1);
        const PathStretch before = stretches[k];
        find_entry(stretches, k);
        if (before.entry > stretches[k].entry &&
            velocity_needed(stretches, relied, k) > stretches[k].entry)
            stretches[k] = before;
        if (was_bound && stretches.is_bound_by_joint(k - 1)) return;
    }
}

}  // namespace lineshaft

#include "blocks/profile/transition.hpp"

#include <algorithm>
#include <cmath>

#include "blocks/profile/polynomial.hpp"

namespace lineshaft {
namespace {

constexpr double nanosecond = 1e-9;
constexpr double rounding = 0x1p-40;

MotionPlan standing(const MotionState& at) {
    MotionPlan p;
    p.end = at;
    return p;
}

MotionPlan as_plan(const VelocityRamp& ramp, double start) {
    MotionPlan p;
    p.count = static_cast<std::size_t>(ramp.count);
    double begin = 0;
    for (std::size_t i = 0; i < p.count; begin += p.phases[i++].duration) {
        p.phases[i] = {begin, ramp.phases[i].duration, ramp.phases[i].start};
        p.phases[i].start.position += start;
    }
    p.duration = ramp.duration;
    p.end = ramp.end;
    p.end.position += start;
    return p;
}

/// The velocity of the slave over a phase.
Polynomial<2> velocity_of(const MotionState& r, const MotionState& g) {
    return {{r.velocity + g.velocity, r.acceleration + g.acceleration, 0.5 * (r.jerk + g.jerk)}};
}

struct Problem {
    TransitionLimits limits;
    MotionState slave, guide;
    TransitionGoal goal;

    /// The rest of rounding is none.
    MotionState relative() const {
        const auto difference = [](double a, double b) {
            const double d = a - b;
            return std::abs(d) <= rounding * std::max(std::abs(a), std::abs(b)) ? 0 : d;
        };
        return {slave.position - guide.position, difference(slave.velocity, guide.velocity),
                difference(slave.acceleration, guide.acceleration), 0};
    }

    /// Within `time` [s] from the start.
    Range guide_velocity(double time) const {
        const Polynomial<2> v{{guide.velocity, guide.acceleration, 0.5 * guide.jerk}};
        return range(v, 0, time);
    }
    Range guide_acceleration(double time) const {
        return range(Polynomial<1>{{guide.acceleration, guide.jerk}}, 0, time);
    }

    PlanResult plan_within(double time, MotionPlan& out) const;
    bool keeps_velocity(const MotionPlan& p) const;
    PlanResult plan(MotionPlan& out) const;
};

/// Under limits that hold if it takes no more than `time` [s].
PlanResult Problem::plan_within(double time, MotionPlan& out) const {
    const Range a = guide_acceleration(time);
    const double A = limits.acceleration - a.greatest, D = limits.deceleration + a.least;
    const double J = limits.jerk - std::abs(guide.jerk);
    const MotionState from = relative();
    if (!goal.catch_up) {
        VelocityRamp ramp;
        const PlanResult result = ramp.plan(from.velocity, from.acceleration, 0, A, D, J);
        if (result == PlanResult::ok) out = as_plan(ramp, from.position);
        return result;
    }
    const Range v = guide_velocity(time);
    MotionLimits around;
    const PlanResult result =
        around.set(limits.velocity - v.greatest, -limits.velocity - v.least, A, D, J);
    if (result == PlanResult::limit_not_positive && A > 0 && D > 0)
        return PlanResult::velocity_above_limit;
    if (result != PlanResult::ok) return result;
    return lineshaft::plan(around, from, {goal.offset, 0}, out);
}

/// Jerk against that of the guide brings the slave's acceleration down slower than it may be: it
/// can be too fast in between.
bool Problem::keeps_velocity(const MotionPlan& p) const {
    const double allowed = std::max(limits.velocity, guide_velocity(p.duration).size());
    for (std::size_t i = 0; i < p.count; ++i) {
        const MotionState r = p.phases[i].start, g = guide.after(p.phases[i].begin);
        if (range(velocity_of(r, g), 0, p.phases[i].duration).size() > allowed) return false;
    }
    return true;
}

/// The limits depend on what the guide does until the end, which depends on them.
PlanResult Problem::plan(MotionPlan& out) const {
    const bool fixed = guide.jerk == 0 && (!goal.catch_up || guide.acceleration == 0);
    MotionPlan tried;
    PlanResult result = PlanResult::limit_not_positive;
    for (double time = 0; time < 1e6;) {
        result = plan_within(time, tried);
        if (result != PlanResult::ok) return result;
        if (fixed || tried.duration <= time) {
            if (guide.jerk != 0 && !keeps_velocity(tried)) break;
            out = tried;
            return result;
        }
        time = 1.2 * tried.duration + nanosecond;
    }
    return PlanResult::limit_not_positive;
}

}  // namespace

MotionState Transition::at(double t) const {
    const MotionState r = plan.at(t), g = guide.after(std::max(t, 0.0));
    return {g.position + r.position, g.velocity + r.velocity, g.acceleration + r.acceleration,
            g.jerk + r.jerk};
}

bool Transition::runs_against(double direction) const {
    for (std::size_t i = 0; i < plan.count; ++i) {
        const MotionState r = plan.phases[i].start, g = guide.after(plan.phases[i].begin);
        const Range v = range(velocity_of(r, g), 0, plan.phases[i].duration);
        const double slack = rounding * v.size();
        if (direction < 0 ? v.greatest > slack : v.least < -slack) return true;
    }
    return false;
}

bool Transition::foresees(const MotionState& now, double t) const {
    const MotionState g = guide.after(t);
    const auto same = [](double a, double b, double size) {
        return std::abs(a - b) <= rounding * std::max({std::abs(a), std::abs(b), size});
    };
    const double a = std::abs(guide.acceleration) + std::abs(guide.jerk * t);
    const double v = std::abs(guide.velocity) + a * t;
    const double x = std::abs(guide.position) + v * t;
    return same(now.position, g.position, x) && same(now.velocity, g.velocity, v) &&
           same(now.acceleration, g.acceleration, a) && same(now.jerk, g.jerk, 0);
}

PlanResult plan(const TransitionLimits& limits, const MotionState& slave, const MotionState& guide,
                const TransitionGoal& goal, Transition& out) {
    Problem problem{limits, slave, guide, goal};
    if (!std::isfinite(guide.position) || !std::isfinite(slave.position) ||
        !std::isfinite(guide.velocity) || !std::isfinite(guide.acceleration) ||
        !std::isfinite(guide.jerk))
        return PlanResult::not_finite;
    if (goal.mode == TransitionMode::step) {
        out.guide = guide;
        out.plan = standing({goal.catch_up ? goal.offset : problem.relative().position, 0, 0, 0});
        return PlanResult::ok;
    }
    if (goal.mode == TransitionMode::acceleration_limited)
        problem.limits.jerk = std::max(limits.acceleration, limits.deceleration) / nanosecond;
    const bool rough = std::abs(guide.jerk) > 0.5 * problem.limits.jerk;
    PlanResult result = PlanResult::limit_not_positive;
    for (const int derivatives : {3, 2, 1}) {
        if (derivatives == 3 && (guide.jerk == 0 || rough)) continue;
        problem.guide.jerk = derivatives > 2 ? guide.jerk : 0;
        problem.guide.acceleration = derivatives > 1 ? guide.acceleration : 0;
        result = problem.plan(out.plan);
        if (result == PlanResult::ok) {
            out.guide = problem.guide;
            break;
        }
    }
    return result;
}

}  // namespace lineshaft

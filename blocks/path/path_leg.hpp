#pragma once

#include <cstdint>

#include "blocks/path/path_course.hpp"
#include "blocks/path/path_stretch.hpp"
#include "blocks/profile/any_state.hpp"

namespace lineshaft {

/// One motion along the path to the end of a stretch, where the acceleration is 0; or, of a halt,
/// to standstill anywhere. A plan is within the boxes of all stretches that it passes, a course
/// within the limits of all pieces.
struct PathLeg {
    MotionPlan plan;         ///< from `base` on
    PathCourse course;       ///< in its place, where it has phases
    double base = 0;         ///< where it begins along the path [u]
    double end = 0;          ///< ... and ends [u]
    double ripe = 0;         ///< until then [s] what comes behind cannot make it any faster
    std::uint64_t goal = 0;  ///< the stretch in which it ends

    double duration() const { return course.count > 0 ? course.duration : plan.duration; }
    double end_velocity() const { return (course.count > 0 ? course.end : plan.end).velocity; }
    MotionState at(double t) const { return course.count > 0 ? course.at(t) : plan.at(t); }

    /// It stands there: at the end of what is behind it, before the stretch `number`.
    void stand(double place, std::uint64_t number);

    /// This plan from `from` on, to a place in a stretch.
    void take(const MotionPlan& motion, double from, double to, std::uint64_t stretch);

    /// The first instant at which no less than a way [u] is behind it; `duration` where it is
    /// shorter [s].
    double time_at(double way) const;
};

/// Where courses were looked for in vain: over fewer legs one is looked for the next time, and
/// none for a leg that ends before a place, or that is under way before it.
struct PathVain {
    double until = 0;  ///< along the path [u]
    std::uint64_t legs = PathCourse::most_phases;
};

/// The next leg from a state (its position is 0) at `base` within the first of the stretches, with
/// `factor` 0..1 of the velocities; 0 is a halt, with acceleration and jerk of `halt` where there
/// is room for that. False, and `out` is unchanged, where there is none: then what was planned goes
/// on.
bool plan_leg(ConstPathStretches stretches, const MotionState& from, double base, double factor,
              const PathLimit& halt, PathLeg& out);

/// The way that a direct ramp takes from a state to a velocity; infinite where there is none [u].
double way_to(const MotionState& from, double velocity, const PathLimit& box);

}  // namespace lineshaft

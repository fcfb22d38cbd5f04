#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blocks/profile/motion_limits.hpp"
#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

/// How a state outside its limits comes back: `gentle` joins the velocity limit tangentially and
/// never falls below it on the way to a far target; `soonest` brakes until it is kept.
enum class Entry : std::int64_t { gentle, soonest };

struct Goal {
    double position = 0;  ///< [u]
    double velocity = 0;  ///< [u/s], in Vmin..V; the acceleration there is 0
};

struct PlanOptions {
    Entry entry = Entry::gentle;
    double tolerance = 64;  ///< [ulp], see MotionPlan
};

struct MotionPlan {
    struct Phase {
        double begin = 0, duration = 0;  ///< [s]; duration > 0
        MotionState start;               ///< its jerk lasts for the phase
    };

    static constexpr std::size_t most_phases = 16;

    std::array<Phase, most_phases> phases{};
    std::size_t count = 0;
    double duration = 0;  ///< [s]
    double drift = 0;     ///< what rounding has left of the way, over the duration [u/s]
    MotionState end;      ///< exactly the goal

    /// State t seconds after the start; t < 0 is taken as 0; after the end: constant velocity.
    MotionState at(double t) const;

    /// The same for times that mostly rise: `phase` is where the last one was found, 0 at first.
    MotionState at(double t, std::size_t& phase) const;

    double greatest_velocity() const;      ///< in either direction [u/s]
    double greatest_acceleration() const;  ///< in either direction [u/s^2]
};

/// From any state to the goal in the least time.
PlanResult plan(const MotionLimits& limits, const MotionState& from, const Goal& to,
                MotionPlan& out, const PlanOptions& options = {});

/// The same in the least feasible duration that is no less than `duration` [s].
PlanResult plan(const MotionLimits& limits, const MotionState& from, const Goal& to,
                double duration, MotionPlan& out, const PlanOptions& options = {});

struct AxisMove {
    const MotionLimits* limits = nullptr;
    MotionState from;
    Goal to;
};

/// Several axes together: each is planned for the least duration, no less than `least` [s], that
/// is feasible for all. `out` has a plan for each axis; when one cannot be planned, none is
/// written.
PlanResult synchronise(std::span<const AxisMove> axes, std::span<MotionPlan> out, double least = 0,
                       const PlanOptions& options = {});

}  // namespace lineshaft

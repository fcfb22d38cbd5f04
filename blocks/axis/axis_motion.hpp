#pragma once

#include <algorithm>
#include <cstdint>

#include "blocks/profile/any_state.hpp"
#include "blocks/profile/velocity_ramp.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// A moment in virtual time, which may lie between two nanoseconds.
struct Moment {
    std::int64_t time = 0;  ///< [ns]
    double later = 0;       ///< [s], 0 <= later < 1 ns, or a little more

    double until(std::int64_t now) const { return seconds(now - time) - later; }  ///< [s]
    Moment after(double duration) const;                                          ///< [s], >= 0

    /// What begins now and takes `duration` [s] has ended at the scan: also if it ends so soon
    /// after that it belongs to it. Virtual time counts whole nanoseconds, sums of doubles round,
    /// and a trapezoid takes a nanosecond longer a ramp, two where it turns round (effective_jerk).
    bool has_passed(double duration, std::int64_t now) const {
        return is_over(duration, until(now));
    }
    /// The same of the time that has passed since [s].
    static bool is_over(double duration, double passed) { return passed + same_scan >= duration; }
    static constexpr double same_scan = 2e-9;  ///< [s]
};

/// The first state, on the way there, of a motion that begins t < 0 seconds ago, so soon after the
/// scan that the one before has ended with it (Moment::has_passed). For t >= 0 it is as it is.
inline MotionState before_start(MotionState state, double t) {
    state.position += std::min(t, 0.0) * state.velocity;
    return state;
}

/// How fast an axis may be in a motion: all above 0. `acceleration` where the speed grows,
/// `deceleration` where it falls, whichever the direction; through standstill the lesser of both.
struct Dynamics {
    double velocity = 0, acceleration = 0, deceleration = 0, jerk = 0;

    bool valid() const;
    bool operator==(const Dynamics&) const = default;
};

/// The lesser of acceleration and deceleration for both: of a motion that turns round.
Dynamics symmetric(Dynamics dynamics);

/// A jerk of 0 is a trapezoid: acceleration that comes in a nanosecond.
double effective_jerk(double jerk, double acceleration, double deceleration);

/// Those of a motion to standstill, with as much jerk, up to `most`, as it takes to be there by the
/// time the acceleration is 0, so that it does not turn round before.
Dynamics without_turning(Dynamics dynamics, const MotionState& from, double most);

/// To a position, and with the velocity that it has there on. In the least time from any state.
struct PointMotion {
    Moment start;
    double duration = 0;    ///< the plan's, or until the position that it passes
    std::size_t phase = 0;  ///< of the plan, where the last look found it
    MotionPlan plan;
    MotionState end_state;  ///< at `duration`

    /// The sign of end_velocity says in which direction the goal is passed. not_finite when the
    /// numbers leave what doubles can hold; *this is then unchanged.
    PlanResult begin(const MotionState& from, double goal, double end_velocity,
                     const Dynamics& dynamics, const Moment& at);

    /// Ends where it passes a position, if the goal is beyond it: what follows goes on from there,
    /// with velocity and acceleration. It must not turn round before.
    void end_at(double position, double direction);
    bool is_cut() const { return duration < plan.duration; }

    /// Whether it runs against the direction (its sign) at some time.
    bool turns(double direction) const;
    double greatest_jerk() const;

    /// The same motion, all its positions further by so much.
    void move(double by);

    MotionState at(std::int64_t now) { return later(start.until(now)); }
    MotionState later(double t) { return before_start(plan.at(t, phase), t); }  ///< t [s]
    bool has_ended(std::int64_t now) const { return start.has_passed(duration, now); }
    Moment end() const { return start.after(duration); }
};

/// To a velocity, and on with it. In the least time from any state.
struct VelocityMotion {
    Moment start;
    double start_position = 0;
    VelocityRamp ramp;

    PlanResult begin(const MotionState& from, double velocity, const Dynamics& dynamics,
                     const Moment& at);
    /// Stands, or goes on as it is.
    void hold(const MotionState& state, const Moment& at);
    /// To rest at a position that lies ahead, with one deceleration from now on, whatever it is and
    /// however far the acceleration jumps. False where numbers are beyond a double.
    bool stand_at(double position, const MotionState& from, const Moment& at);

    MotionState at(std::int64_t now) const { return later(start.until(now)); }
    MotionState later(double t) const;  ///< t seconds after the start
    bool has_ended(std::int64_t now) const { return start.has_passed(ramp.duration, now); }
    Moment end() const { return start.after(ramp.duration); }
    /// When the ramp ends.
    MotionState end_state() const;
    double greatest_jerk() const;
};

/// The way of a ramp between two velocities of one sign, both at acceleration 0.
double ramp_way(double from, double to, const Dynamics& dynamics);

/// Where an axis would stand that brakes at once from the state.
double stopping_position(const MotionState& from, const Dynamics& dynamics);

}  // namespace lineshaft

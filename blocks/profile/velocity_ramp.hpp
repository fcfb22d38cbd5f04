#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

namespace lineshaft {

/// Motion along one axis at one instant. Units are the caller's: u, u/s, u/s^2, u/s^3.
struct MotionState {
    double position = 0;
    double velocity = 0;
    double acceleration = 0;
    double jerk = 0;

    /// State dt seconds later if the jerk stays: x + v dt + a dt^2/2 + j dt^3/6.
    MotionState after(double dt) const {
        return {position + dt * (velocity + dt * (acceleration * 0.5 + dt * (jerk * (1.0 / 6)))),
                velocity + dt * (acceleration + dt * (jerk * 0.5)), acceleration + dt * jerk, jerk};
    }
};

enum class PlanResult {
    ok,
    limit_not_positive,  ///< an acceleration, jerk or velocity limit is zero, negative or not
                         ///< finite
    not_finite,          ///< a velocity, acceleration or length is NaN or infinite, or the plan is
    velocity_above_limit,  ///< start or end velocity outside its limits
    negative_length,       ///< length below zero (seven-segment move only)
};

inline constexpr std::string_view plan_result_names[] = {"ok", "limit_not_positive", "not_finite",
                                                         "velocity_above_limit", "negative_length"};

constexpr std::string_view name(PlanResult result) {
    return plan_result_names[static_cast<std::size_t>(result)];
}

/// The pieces of a velocity ramp, counted along its direction: jerk towards the peak acceleration,
/// hold, jerk to zero.
struct RampShape {
    double to_peak = 0, hold = 0, to_zero = 0;  ///< durations [s]
    double peak = 0;                            ///< acceleration [u/s^2]
    double jerk = 0;                            ///< towards the peak [u/s^3]
};

/// What is missing to v1 once a0 has been brought to zero at once, a0 |a0| half_per_jerk = a0 |a0|
/// / (2J) further; 0 if that is mere rounding.
inline double missing_velocity(double v0, double a0, double v1, double half_per_jerk) {
    if (a0 == 0) return v1 - v0;
    const double gained = a0 * std::abs(a0) * half_per_jerk;
    const double e = (v1 - v0) - gained;
    const double rounding = 2 * std::numeric_limits<double>::epsilon() *
                            std::max({std::abs(v0), std::abs(v1), std::abs(gained)});
    return std::abs(e) <= rounding ? 0 : e;
}

/// From acceleration a over the limit A or what the missing velocity e >= 0 needs, to zero.
/// Selects instead of branching: which case it is cannot be foreseen.
inline RampShape ramp_shape(double a, double e, double A, double J) {
    const bool above = a > A;
    const double peak_square = J * e + (a > 0 ? a * a : 0);
    const bool held = above || peak_square > A * A;
    const double peak = held ? A : std::sqrt(peak_square);
    const bool cancels = a > 0 && !held;
    const double to_peak = (cancels ? e : std::abs(peak - a)) / (cancels ? peak + a : J);
    const double held_gain = above ? J * e : peak_square - A * A;
    return {to_peak, held ? held_gain / (J * A) : 0, peak / J, peak, above ? -J : J};
}

/// Time-optimal change of velocity under an acceleration and a jerk limit, ending with zero
/// acceleration. Starts from any velocity and any acceleration: a ratio may change in
/// mid-transition. An acceleration above the limit is first brought down to it.
///
/// Bringing a0 to zero at once ends at v0 + a0 |a0| / (2 J). What is then missing,
///
///     e = v1 - v0 - a0 |a0| / (2 J),
///
/// has the sign s of the ramp's direction; with a0 and e counted along s the peak acceleration is
///
///     ap = sqrt(J e + max(a0, 0)^2),                 held at A for (ap^2 - A^2) / (J A) if ap > A
///
/// and the jerk is +J from a0 to the peak, 0, -J from the peak to zero. From a0 > A it is -J down
/// to A, held for e / A, then -J down to zero. If a0 overshoots v1, s is the way back and the first
/// phase runs through zero acceleration. If e is no more than the rounding of its own terms the
/// ramp only brings a0 to zero.
struct VelocityRamp {
    struct Phase {
        double duration = 0;  ///< [s], > 0
        MotionState start;  ///< state at the phase's start; position counted from the ramp's start
    };

    int count = 0;        ///< phases used, at most three
    double duration = 0;  ///< of the whole ramp [s]
    MotionState end;      ///< end.velocity is exactly the wanted velocity, end.acceleration 0,
                          ///< end.position the distance travelled
    std::array<Phase, 4> phases{};

    /// v0 [u/s], a0 [u/s^2] -> v1 [u/s] with limits A [u/s^2], J [u/s^3]. On failure *this is
    /// unchanged.
    PlanResult plan(double v0, double a0, double v1, double acceleration, double jerk) {
        return plan(v0, a0, v1, acceleration, acceleration, jerk);
    }

    /// With limits of their own upwards (acceleration) and downwards (deceleration, > 0) [u/s^2].
    PlanResult plan(double v0, double a0, double v1, double acceleration, double deceleration,
                    double jerk);

    /// State t seconds after the start; t < 0 is taken as 0; after the end: constant velocity.
    MotionState at(double t) const;
};

/// Duration of a ramp of |dv| from and to zero acceleration [s]:
/// A/J + dv/A if dv >= A^2/J, else 2 sqrt(dv/J) (Wei et al. 2025, section 1.3, exact form).
double ramp_duration(double dv, double acceleration, double jerk);

}  // namespace lineshaft

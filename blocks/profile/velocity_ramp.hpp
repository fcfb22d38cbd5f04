#pragma once

#include <array>

namespace lineshaft {

/// Motion along one axis at one instant. Units are the caller's: u, u/s, u/s^2, u/s^3.
struct MotionState {
    double position = 0;
    double velocity = 0;
    double acceleration = 0;
    double jerk = 0;
};

enum class PlanResult {
    ok,
    limit_not_positive,  ///< an acceleration, jerk or velocity limit is zero, negative or not finite
    not_finite,          ///< a velocity, acceleration or length is NaN or infinite
    velocity_above_limit,  ///< start or end velocity outside 0..Vm (seven-segment move only)
    negative_length,       ///< length below zero (seven-segment move only)
};

/// Time-optimal change of velocity under an acceleration and a jerk limit, ending with zero
/// acceleration. Starts from any velocity and any acceleration: a ratio may change in mid-transition.
/// An acceleration above the limit is first brought down to it. At most four phases of constant jerk.
struct VelocityRamp {
    struct Phase {
        double duration = 0;  ///< [s], >= 0
        MotionState start;    ///< state at the phase's start; position counted from the ramp's start
    };

    std::array<Phase, 4> phases{};
    int count = 0;               ///< phases used
    double duration = 0;         ///< of the whole ramp [s]
    MotionState end;             ///< end.velocity is exactly the wanted velocity, end.acceleration 0
                                 ///< end.position the distance travelled

    /// v0 [u/s], a0 [u/s^2] -> v1 [u/s] with limits A [u/s^2], J [u/s^3]. On failure *this is unchanged.
    PlanResult plan(double v0, double a0, double v1, double acceleration, double jerk);

    /// State t seconds after the start; t < 0 is taken as 0; after the end: constant velocity.
    MotionState at(double t) const;
};

/// Duration of a ramp of |dv| from and to zero acceleration [s]:
/// A/J + dv/A if dv >= A^2/J, else 2 sqrt(dv/J) (Wei et al. 2025, section 1.3, exact form).
double ramp_duration(double dv, double acceleration, double jerk);

}  // namespace lineshaft

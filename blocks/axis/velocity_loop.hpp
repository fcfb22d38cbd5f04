#pragma once

#include <cstdint>

namespace lineshaft {

/// A motor under velocity control, and its friction. Forces stand as accelerations (force over the
/// moved mass), u is the demanded velocity, constant during each advance, s = sign of v:
///
///     ideal          v = u
///     first_order    v' = (u - v) / T - c s - d v                  P controller, T = mass / gain
///     second_order   v' = z - 2 zeta w v - c s - d v               state space (v, z): I-P
///                    z' = w^2 (u - v)                              controller, z its integral
///
/// without friction v/u = 1 / (1 + T p) and w^2 / (p^2 + 2 zeta w p + w^2). At v = 0 the motor
/// sticks while the drive (u / T, or z) is not above Coulomb friction c. An ideal loop is stiff:
/// friction does not change its motion.
///
/// Advanced by the exact solution (the matrix exponential in closed form), whatever the interval.
/// A change of sign of v is found inside the interval, when it shows at its end.
struct VelocityLoop {
    enum class Kind : std::int64_t { ideal, first_order, second_order };

    Kind kind = Kind::ideal;
    double time_constant = 0;      ///< T [s], above 0 in first_order
    double natural_frequency = 0;  ///< w [rad/s], above 0 in second_order
    double damping = 1;            ///< zeta, not below 0
    double coulomb = 0;            ///< c [u/s^2], not below 0
    double viscous = 0;            ///< d [1/s], not below 0

    struct State {
        double position = 0;  ///< [u]
        double velocity = 0;  ///< v [u/s]
        double integral = 0;  ///< z [u/s^2], 0 but in second_order
    };

    /// `from`, a time `t` [s] later.
    State advance(const State& from, double u, double t) const;

  private:
    double drive(const State& state, double u) const;
    State slide(const State& from, double u, double friction, double t) const;
    State slide_first_order(const State& from, double u, double friction, double t) const;
    State slide_second_order(const State& from, double u, double friction, double t) const;
    double stick(State& state, double u, double t) const;
    double time_to_zero(const State& from, double u, double friction, double t) const;
};

}  // namespace lineshaft

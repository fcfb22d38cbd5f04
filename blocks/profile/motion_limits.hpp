#pragma once

#include <array>

#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

/// The limits of a motion with what follows from them, prepared once for many plans. `side[0]` sees
/// them as they are, `side[1]` mirrored: backwards is forwards there, and A and D change places.
struct MotionLimits {
    struct Side {
        double V = 1;                 ///< greatest velocity towards the side [u/s]
        double A = 1, D = 1;          ///< greatest acceleration towards the side, and away [u/s^2]
        double alpha = 1, delta = 1;  ///< jerk times A/J and D/J [s]
        double rise = 1, fall = 1;    ///< A^2/J and D^2/J: more than that, and a ramp holds [u/s]
        double per_A = 1, per_D = 1;
    };

    std::array<Side, 2> side;
    double J = 1;  ///< greatest jerk, both ways [u/s^3]
    double per_J = 1;

    /// V > 0 forwards, Vmin < 0 backwards [u/s], A upwards and D downwards, both > 0 [u/s^2], J > 0
    /// [u/s^3]. limit_not_positive where a limit is zero, of the wrong sign, or not finite;
    /// not_finite where a quotient of them is beyond a double. On failure *this is unchanged.
    PlanResult set(double V, double Vmin, double A, double D, double J);
};

}  // namespace lineshaft

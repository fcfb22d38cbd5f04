#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

/// The equations for the jerk times of two ramps that meet in a peak, shared by the planners.
namespace lineshaft {

/// c4 x^4 + c3 x^3 + c2 x^2 + c1 x + c0
struct Quartic {
    double c4, c3, c2, c1, c0;
};

/// A relative step after which Householder's iteration of the fourth order leaves only rounding.
inline constexpr double householder_near = 3e-5;

/// The root in [low, high] where p rises through zero, by Householder's iteration of the fourth
/// order from x, until a step is no greater than grain. A step out of the bracket ends at its
/// border, or halves it where that has been tried. NaN where a term is beyond a double.
inline double rising_root(const Quartic& p, double x, double grain, double low, double high) {
    bool low_tried = false, high_tried = false;
    for (int i = 0; i < 100; ++i) {
        const double xx = x * x;
        const double f0 = ((p.c4 * xx + p.c2) * x + (p.c3 * xx + p.c1)) * x + p.c0;
        const double f1 = (4 * p.c4 * xx + 2 * p.c2) * x + (3 * p.c3 * xx + p.c1);
        const double f2 = 6 * p.c4 * xx + (3 * p.c3 * x + p.c2);
        const double f3 = 4 * p.c4 * x + p.c3;
        (f0 < 0 ? low : high) = x;
        (f0 < 0 ? low_tried : high_tried) = true;
        const double newton = f1 * f1 - f0 * f2;
        const double step = f0 * newton / (f1 * (newton - f0 * f2) + f0 * f0 * f3);
        double next = f0 == 0 ? x : x - step;
        if (std::isnan(next)) return next;
        if (!(next >= low)) next = low_tried ? 0.5 * (low + high) : low;
        if (!(next <= high)) next = high_tried ? 0.5 * (low + high) : high;
        const bool done = std::abs(next - x) <= grain;
        x = next;
        if (done) break;
    }
    return x;
}

/// What rounding took from a product: a b = product + product_error, exactly (Dekker 1971).
inline double product_error(double a, double b, double product) {
    constexpr double split = 0x1p27 + 1;
    const double aa = split * a;
    const double a1 = aa - (aa - a);
    const double a2 = a - a1;
    const double bb = split * b;
    const double b1 = bb - (bb - b);
    const double b2 = b - b1;
    return ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2;
}

/// Within 3 percent: a third of the exponent, the mantissa carried along.
inline double rough_cube_root(double x) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + 0x2A9F7893782DA1CEu);
}

/// Root of a s^3 + b s = r within some percent, k being about the root for b = 0: k (1 + 0.602 q) /
/// (1 + 0.770 q + 0.602 q^2) with q = b / (a k^2), right for small and for great q.
inline double rough_root(double a, double b, double k) {
    const double g = a * k * k;
    return k * g * (g + 0.602 * b) / (g * g + b * (0.770 * g + 0.602 * b));
}

/// Both ramps triangular: the sum m of their jerk times in [low, high],
///     J/4 m^4 + S m^2 - L m - Dv^2/(4J) = 0,
/// S and Dv sum and difference of the velocities at their feet, L the length of both.
inline double triangular_sum(double J, double S, double Dv, double L, double low, double high) {
    double guess = low;
    if (L > 0 && S >= 0)
        guess = rough_root(0.25 * J, S, rough_cube_root(4 * L / J));
    else if (L > 0) {
        const double k = rough_cube_root(4 * L / J);
        guess = std::sqrt(k * k - 4 * S / J);
    } else if (S < 0) {
        guess = std::sqrt(-4 * S / J);
    }
    guess = std::max(low, std::min(high, guess));
    return rising_root({0.25 * J, 0, S, -L, -0.25 * Dv * Dv / J}, guess, householder_near * guess,
                       low, high);
}

/// One ramp triangular, with velocity v at its foot, the other trapezoidal with jerk time t and c =
/// J t^2: the jerk time s of the triangular one in [low, high],
///     J/(2t) s^4 + J s^3 + (v + c/2)/t s^2 + 2 v s - rest = 0,
/// rest the length that is left by a trapezoidal ramp from foot to foot.
inline Quartic mixed_equation(double J, double v, double t, double c, double rest) {
    return {0.5 * J / t, J, (v + 0.5 * c) / t, 2 * v, -rest};
}

inline double mixed_time(double J, double v, double t, double c, double rest, double low,
                         double high) {
    const double h = 1.7 * v / c;
    const double r = 2 * rest / (c * t);
    const double root = std::sqrt(std::max(0.0, h * h + r));
    const double z = h >= 0 ? r / (h + root) : root - h;
    const double guess =
        std::max(low, std::min(high, t * (2 * z / (1 + std::sqrt(std::max(0.0, 1 + 4 * z))))));
    const double grain = std::max(householder_near * guess, 0x1p-53 * t);
    return rising_root(mixed_equation(J, v, t, c, rest), guess, grain, low, high);
}

}  // namespace lineshaft

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

/// Its step, with the value f0, the first derivative f1, half the second f2 and a sixth of the
/// third f3: what x is to be less.
inline double householder_step(double f0, double f1, double f2, double f3) {
    const double newton = f1 * f1 - f0 * f2;
    return f0 * newton / (f1 * (newton - f0 * f2) + f0 * f0 * f3);
}

/// The root in [low, high] where p rises through zero, by Householder's iteration of the fourth
/// order from x, until a step is no greater than near |x|. A step out of the bracket halves it.
/// NaN where a term is beyond a double.
inline double rising_root(const Quartic& p, double x, double near, double low, double high) {
    for (int i = 0; i < 100; ++i) {
        const double xx = x * x;
        const double f0 = ((p.c4 * xx + p.c2) * x + (p.c3 * xx + p.c1)) * x + p.c0;
        const double f1 = (4 * p.c4 * xx + 2 * p.c2) * x + (3 * p.c3 * xx + p.c1);
        const double f2 = 6 * p.c4 * xx + (3 * p.c3 * x + p.c2);
        const double f3 = 4 * p.c4 * x + p.c3;
        if (f0 == 0) return x;
        (f0 < 0 ? low : high) = x;
        const double step = householder_step(f0, f1, f2, f3);
        if (std::isnan(step)) return step;
        const double next = x - step;
        const bool inside = next >= low && next <= high;
        const double last = x;
        x = inside ? next : 0.5 * (low + high);
        if (x == last || (inside && std::abs(step) <= near * x)) break;
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

/// Where the equations begin: two ramps over the peak velocity v, whose triangular ones have the
/// jerk times q and r and are to become longer.
struct PeakStart {
    double J, v, q, r;
    double m;  ///< q + r, which may be less than both roundings
};

/// Both ramps triangular: the sum m + y of their jerk times that adds the length `miss` > 0,
///     J/4 y^4 + J m y^3 + (2v + J (q^2 + 6qr + r^2)/2) y^2 + m (2v + Jqr) y = miss (m + y).
inline Quartic triangular_equation(const PeakStart& s, double miss) {
    const double qr = s.q * s.r, c2 = 2 * s.v + s.J * (0.5 * (s.q * s.q + s.r * s.r) + 3 * qr);
    return {0.25 * s.J, s.J * s.m, c2, s.m * (2 * s.v + s.J * qr) - miss, -miss * s.m};
}

inline double triangular_step(const PeakStart& s, double miss, double high) {
    const Quartic p = triangular_equation(s, miss);
    const double k = rough_cube_root(miss / p.c4), part = 1 / (s.m + k);
    const double a = (p.c4 * k + p.c3) * part, b = (p.c2 * k + p.c1 + miss) * part;
    const double guess =
        b >= 0 ? rough_root(a, b, k * rough_cube_root(p.c4 / a)) : std::sqrt(k * k - b / a);
    return rising_root(p, std::min(high, guess), householder_near, 0, high);
}

/// One ramp triangular with the jerk time q, the other held after the jerk time t: the jerk time q
/// + x that adds the length `miss` > 0,
///     J/(2t) x^4 + J (1 + 2q/t) x^3 + (v/t + J (2q^2/t + 3q + t/2)) x^2 + (1 + q/t)(2v + Jqt) x =
///     miss.
inline Quartic mixed_equation(const PeakStart& s, double t, double miss) {
    const double per_t = 1 / t, u = s.q * per_t;
    return {0.5 * s.J * per_t, s.J * (1 + 2 * u), s.v * per_t + s.J * ((2 * u + 3) * s.q + 0.5 * t),
            (1 + u) * (2 * s.v + s.J * s.q * t), -miss};
}

inline double mixed_step(const PeakStart& s, double t, double miss, double high) {
    const Quartic p = mixed_equation(s, t, miss);
    const double per_t = 1 / t, u = s.q * per_t, z0 = u * (u + 1), c = s.J * t * t;
    const double h = 1.7 * (s.v / c - u * u);
    const double r = z0 * z0 + 2 * h * z0 + 2 * miss * per_t / c;
    const double root = std::sqrt(std::max(0.0, h * h + r));
    const double z = h >= 0 ? r / (h + root) : root - h;
    const double q = t * (2 * z / (1 + std::sqrt(std::max(0.0, 1 + 4 * z))));
    return rising_root(p, std::max(0.0, std::min(high, q - s.q)), householder_near, 0, high);
}

}  // namespace lineshaft

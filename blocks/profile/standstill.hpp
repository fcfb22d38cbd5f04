#pragma once

#include "blocks/profile/peak_motion.hpp"

/// Motions from standstill to standstill, `miss` > 0 ahead, as most are. Nothing of them is there
/// before they begin: what peak_motion.hpp's general way adds and multiplies as zeros is left out
/// here, and what remains are its operations in its order, with the same bits.
namespace lineshaft::peak_motion {

/// Both ramps triangular: the sum of their jerk times, the root of J/4 y^3 = miss in (0, high], by
/// the steps of triangular_step.
static inline double triangular_from_standstill(double J, double miss, double high) {
    const double c4 = 0.25 * J, first = rough_cube_root(miss / c4), a = c4 * first * (1 / first);
    const double k = first * rough_cube_root(c4 / a), g = a * k * k;
    double low = 0, x = std::min(high, k * g * g / (g * g));
    for (int i = 0; i < 100; ++i) {
        const double f1 = 4 * c4 * (x * x) * x - miss;
        const double f0 = (c4 * (x * x) * x - miss) * x, f2 = 6 * c4 * (x * x), f3 = 4 * c4 * x;
        if (f0 == 0) return x;
        (f0 < 0 ? low : high) = x;
        const double step = householder_step(f0, f1, f2, f3);
        if (std::isnan(step)) return step;
        const double next = x - step, last = x;
        const bool inside = next >= low && next <= high;
        x = inside ? next : 0.5 * (low + high);
        if (x == last || (inside && std::abs(step) <= householder_near * x)) break;
    }
    return x;
}

/// What lies between standstill and V, of which the fullest motion would go too far.
static inline Peak below_limit(const Frame& f, double miss) {
    const MotionLimits::Side& side = *f.side;
    const bool up_first = side.rise < side.fall;
    const double first = std::min(side.rise, side.fall), second = std::max(side.rise, side.fall);
    const double root = std::sqrt(first * f.per_J);
    const double q = up_first ? side.alpha : root, r = up_first ? root : side.delta;
    const double beyond_first = miss - (first * q + first * r);
    if (!(first < side.V && beyond_first > 0)) {
        const double y = triangular_from_standstill(f.J, miss, side.alpha + side.delta);
        const double half = 0.5 * y / y * y;
        return {half, 0, half, 0, half, 0, y, f.J * half * half};
    }
    const Ramp held = up_first ? ramp(second, f.per_J, side.per_A, side.alpha, side.rise)
                               : ramp(second, f.per_J, side.per_D, side.delta, side.fall);
    const double up = up_first ? held.jerk_time : side.alpha, up_hold = up_first ? held.hold : 0;
    const double down = up_first ? side.delta : held.jerk_time,
                 down_hold = up_first ? 0 : held.hold;
    const double beyond_second =
        miss - (second * (up + 0.5 * up_hold) + second * (down + 0.5 * down_hold));
    if (!(second < side.V && beyond_second > 0)) {
        Peak p{q, 0, q, 0, r, 0, q + r, first};
        go_farther(f, p, {up_first, !up_first}, beyond_first);
        return p;
    }
    Peak p{up, up_hold, up, 0, down, down_hold, up + down, second};
    go_farther(f, p, {true, true}, beyond_second);
    return p;
}

static inline Peak from_standstill(const Frame& f, double miss) {
    const MotionLimits::Side& side = *f.side;
    const double V = side.V;
    const Ramp up = ramp(V, f.per_J, side.per_A, side.alpha, side.rise);
    const Ramp down = ramp(V, f.per_J, side.per_D, side.delta, side.fall);
    const double rest =
        miss - (V * (up.jerk_time + 0.5 * up.hold) + V * (down.jerk_time + 0.5 * down.hold));
    Peak p =
        rest < 0 ? below_limit(f, miss) : Peak{up.jerk_time,   up.hold,   up.jerk_time, rest / V,
                                               down.jerk_time, down.hold, 0.0,          V};
    if (p.cruise > 0)
        fit_cruise(f, p);
    else if (p.up_hold > 0 || p.down_hold > 0)
        fit_turn(p, p.q, 0, ulp * f.per_J * p.v);
    return p;
}

}  // namespace lineshaft::peak_motion

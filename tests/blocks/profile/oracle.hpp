#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>

#include "blocks/profile/seven_segment.hpp"

namespace lineshaft::oracle {

/// Quadruple precision: 113 bits, 34 digits.
#ifdef __SIZEOF_FLOAT128__
__extension__ using Quad = __float128;
#else
using Quad = long double;  // of 113 bits where there is no __float128, as on AArch64
static_assert(std::numeric_limits<Quad>::digits == 113);
#endif

inline Quad square_root(Quad x) {
    if (x <= 0) return 0;
    if (x < Quad(1e-300)) return square_root(x * 0x1p200) * 0x1p-100;
    Quad y = std::sqrt(static_cast<double>(x));
    for (int i = 0; i < 2; ++i) y = (y + x / y) / 2;
    return y;
}

inline double ulp(double x) {
    return std::nextafter(x, HUGE_VAL) - x;
}

/// SplitMix64: the same numbers with every library.
struct Random {
    std::uint64_t state;

    std::uint64_t next() {
        std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    bool one_in(std::uint64_t n) { return next() % n == 0; }
    double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    double sign() { return one_in(2) ? 1 : -1; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    double decades(double low, double high) { return std::pow(10, between(low, high)); }
};

/// A failing problem as one line that reproduces it.
inline std::string line(const SevenSegment& p) {
    char text[256];
    std::snprintf(text, sizeof text,
                  "SevenSegment{.Vs = %.17g, .Ve = %.17g, .Vm = %.17g, .A = %.17g, .J = %.17g, "
                  ".L = %.17g}",
                  p.Vs, p.Ve, p.Vm, p.A, p.J, p.L);
    return text;
}

/// Past the test framework, which would break the line.
inline void print_failure(const std::string& why, const std::string& problem) {
    std::fprintf(stderr, "%s: %s\n", why.c_str(), problem.c_str());
}

struct Ramp {
    Quad length, duration;
};

/// A ramp from V to V + dv from and to zero acceleration, equation (9) of Liu 2023. Told the change
/// because the end would lose its digits beside a great V.
inline Ramp ramp_by(Quad V, Quad dv, const SevenSegment& p) {
    const Quad change = dv > 0 ? dv : -dv;
    const Quad A = p.A;
    const Quad J = p.J;
    const Quad duration = change * J > A * A ? change / A + A / J : 2 * square_root(change / J);
    return {(V + dv / 2) * duration, duration};
}

inline Ramp ramp(Quad from, Quad to, const SevenSegment& p) {
    return ramp_by(from, to - from, p);
}

/// Both ramps over a peak that lies w above the faster end.
inline Ramp over_peak(Quad w, const SevenSegment& p) {
    const Quad lo = std::min(p.Vs, p.Ve);
    const Quad hi = std::max(p.Vs, p.Ve);
    const Ramp a = ramp_by(lo, hi - lo + w, p);
    const Ramp b = ramp_by(hi, w, p);
    return {a.length + b.length, a.duration + b.duration};
}

inline Quad length_over(Quad peak, const SevenSegment& p) {
    return over_peak(peak - std::max(p.Vs, p.Ve), p).length;
}

inline Quad L1(const SevenSegment& p) {
    return ramp(p.Vs, p.Ve, p).length;
}
inline Quad L2(const SevenSegment& p) {
    return length_over(p.Vm, p);
}

/// Zero of an increasing function between 0 and high: a bracket narrowed by secants (Illinois) and,
/// every third time, by halving.
template <typename Function>
Quad zero(const Function& function, Quad high) {
    Quad a = 0, b = high;
    Quad fa = function(a), fb = function(b);
    Quad last = a;
    bool was_low = false, was_high = false;
    for (int i = 1; i < 900 && fa < 0 && fb > 0; ++i) {
        const Quad x = i % 3 == 0 ? (a + b) / 2 : a - fa * (b - a) / (fb - fa);
        const Quad fx = function(x);
        const Quad moved = x > last ? x - last : last - x;
        if (fx == 0 || (i % 3 != 0 && moved <= Quad(1e-22) * x)) return x;
        if (i % 3 != 0) last = x;
        const bool low = fx < 0;
        (low ? a : b) = x;
        (low ? fa : fb) = fx;
        if (low && was_low) fb /= 2;
        if (!low && was_high) fa /= 2;
        was_low = low;
        was_high = !low;
    }
    return fa >= 0 ? a : fb <= 0 ? b : (a + b) / 2;
}

struct Optimum {
    Quad duration, end_velocity, peak;
};

/// The end velocity cannot be reached: the first velocity towards it that the length allows.
inline Optimum one_ramp(const SevenSegment& p) {
    const Quad Vs = p.Vs;
    const Quad way = p.Ve >= p.Vs ? 1 : -1;
    // The length of a deceleration has its maximum at Vs/3, or at A^2/(2J) if trapezoidal there.
    Quad range = way > 0 ? Quad(p.Ve) - Vs : Vs - Quad(p.Ve);
    const Quad c = Quad(p.A) * p.A / p.J;
    if (way < 0)
        range = std::min(range, std::max(Vs - c / 2, Quad(0)) > c ? Vs - c / 2 : 2 * Vs / 3);
    const auto excess = [&](Quad u) { return ramp_by(Vs, way * u * u, p).length - Quad(p.L); };
    const Quad u = zero(excess, square_root(range));
    const Quad end = Vs + way * u * u;
    return {ramp_by(Vs, way * u * u, p).duration, end, std::max(Vs, end)};
}

/// The fastest move of this shape, found without any of the closed forms: the peak velocity is
/// bracketed between the faster end and Vm, counted from the faster end as a square because the
/// length grows with the square root there.
inline Optimum optimum(const SevenSegment& p, bool reaches_Ve) {
    if (!reaches_Ve) return one_ramp(p);
    const Quad L = p.L;
    const Quad hi = std::max(p.Vs, p.Ve);
    if (L <= L1(p)) return {ramp(p.Vs, p.Ve, p).duration, p.Ve, hi};
    const Quad rest = L - L2(p);
    const Quad range = p.Vm - hi;
    if (rest >= 0) return {over_peak(range, p).duration + rest / p.Vm, p.Ve, p.Vm};
    const auto excess = [&](Quad u) { return over_peak(u * u, p).length - L; };
    const Quad u = zero(excess, square_root(range));
    return {over_peak(u * u, p).duration, p.Ve, hi + u * u};
}

}  // namespace lineshaft::oracle

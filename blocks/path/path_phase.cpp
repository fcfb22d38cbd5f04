#include "blocks/path/path_phase.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lineshaft {

namespace {

constexpr std::size_t most_terms = 13;

/// 1 / (2n + first)! for all terms.
constexpr std::array<double, most_terms> inverse_factorials(double first) {
    std::array<double, most_terms> out{};
    double last = first, factorial = first;
    for (double& inverse : out) {
        inverse = 1 / factorial;
        factorial *= (last + 1) * (last + 2);
        last += 2;
    }
    return out;
}

constexpr auto of_sine = inverse_factorials(1), of_cosine = inverse_factorials(2);

/// sinh(r)/r and (cosh(r) - 1)/r^2 with r^2 = z, also below 0: sin and cos then.
struct Stumpff {
    double sine = 0, cosine = 0;

    explicit Stumpff(double z) {
        constexpr double small = 0.25;
        constexpr std::size_t few_terms = 8;
        for (std::size_t n = std::abs(z) < small ? few_terms : most_terms; n-- > 0;) {
            sine = of_sine[n] + sine * z;
            cosine = of_cosine[n] + cosine * z;
        }
    }
};

}  // namespace

MotionState PathPhase::after(double t) const {
    if (slope == 0) return start.after(t);
    const double z = slope * t * t;
    const Stumpff f(z);
    const double v = start.velocity, a = start.acceleration;
    const double way = t * (v * f.sine + a * t * f.cosine);
    const double velocity = v * (1 + z * f.cosine) + a * t * f.sine;
    return {start.position + way, velocity, a + slope * way, slope * velocity};
}

double time_at_way(const MotionState& start, double duration, double way) {
    MotionState from = start;
    from.position = 0;
    double lo = 0, hi = duration;
    double t = from.velocity > 0 ? std::min(way / from.velocity, duration) : 0.5 * duration;
    for (int step = 0; step < 64 && hi > lo; ++step) {
        const MotionState s = from.after(t);
        const double missing = way - s.position;
        if (std::abs(missing) <= 1e-15 * way) break;
        (missing > 0 ? lo : hi) = t;
        double next = s.velocity > 0 ? t + missing / s.velocity : lo - 1;
        if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
        if (std::abs(next - t) <= 1e-15 * duration) break;
        t = next;
    }
    return t;
}

double time_at_way(const PathPhase& phase, double duration, double way) {
    if (phase.slope == 0) return time_at_way(phase.start, duration, way);
    const double v = phase.start.velocity;
    const double square = v * v + way * (2 * phase.start.acceleration + phase.slope * way);
    return std::min(duration, duration_over(phase, way, std::sqrt(std::max(square, 0.0))));
}

double duration_over(const PathPhase& phase, double way, double v) {
    double t = 2 * way / (phase.start.velocity + v);
    for (int step = 0; step < 8; ++step) {
        const MotionState s = phase.after(t);
        const double missed = way - (s.position - phase.start.position);
        if (std::abs(missed) <= 1e-15 * way || !(s.velocity > 0)) break;
        t += missed / s.velocity;
    }
    return t;
}

}  // namespace lineshaft

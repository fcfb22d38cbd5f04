#include "blocks/path/path_phase.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

namespace {

/// sinh(r)/r and (cosh(r) - 1)/r^2 with r^2 = z, also below 0: sin and cos then.
struct Stumpff {
    double sine = 1, cosine = 0.5;

    explicit Stumpff(double z) {
        constexpr int most_terms = 12;
        double s = 1, c = 1;
        for (int n = most_terms; n > 0; --n) {
            s = 1 + s * z / (2 * n * (2 * n + 1));
            c = 1 + c * z / ((2 * n + 1) * (2 * n + 2));
        }
        sine = s;
        cosine = 0.5 * c;
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

double time_at_way(const MotionState& from, double duration, double way) {
    double lo = 0, hi = duration;
    double t = from.velocity > 0 ? std::min(way / from.velocity, duration) : 0.5 * duration;
    for (int step = 0; step < 64 && hi > lo; ++step) {
        const MotionState s = from.after(t);
        const double missing = way - (s.position - from.position);
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

#include "blocks/profile/velocity_ramp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lineshaft {
namespace {

bool is_limit(double x) {
    return x > 0 && x <= std::numeric_limits<double>::max();
}

/// A phase of no length leaves no trace: the next one starts from its own exact start state.
void append(VelocityRamp& ramp, double duration, double velocity, double acceleration,
            double jerk) {
    if (duration <= 0) return;
    double position = 0;
    if (ramp.count > 0) {
        const auto& last = ramp.phases[static_cast<std::size_t>(ramp.count - 1)];
        position = last.start.after(last.duration).position;
    }
    ramp.phases[static_cast<std::size_t>(ramp.count)] = {duration,
                                                         {position, velocity, acceleration, jerk}};
    ++ramp.count;
    ramp.duration += duration;
}

/// What is missing to v1 once a0 has been brought to zero, or 0 if that is mere rounding.
double missing_velocity(double v0, double a0, double v1, double J) {
    if (a0 == 0) return v1 - v0;
    const double gained = a0 * std::abs(a0) / (2 * J);
    const double e = (v1 - v0) - gained;
    const double rounding = 2 * std::numeric_limits<double>::epsilon() *
                            std::max({std::abs(v0), std::abs(v1), std::abs(gained)});
    return std::abs(e) <= rounding ? 0 : e;
}

/// Appends the phases from a up to the peak; accelerations and e count along s. Returns the peak.
double reach_peak(VelocityRamp& ramp, double v0, double s, double a, double e, double A, double J) {
    if (a > A) {
        append(ramp, (a - A) / J, v0, s * a, -s * J);
        append(ramp, e / A, v0 + s * ((a - A) * (a + A) / (2 * J)), s * A, 0);
        return A;
    }
    const double peak_square = J * e + (a > 0 ? a * a : 0);
    if (peak_square > A * A) {
        append(ramp, (A - a) / J, v0, s * a, s * J);
        append(ramp, (peak_square - A * A) / (J * A), v0 + s * ((A - a) * (A + a) / (2 * J)), s * A,
               0);
        return A;
    }
    const double peak = std::sqrt(peak_square);
    append(ramp, a > 0 ? e / (peak + a) : (peak - a) / J, v0, s * a, s * J);
    return peak;
}

}  // namespace

PlanResult VelocityRamp::plan(double v0, double a0, double v1, double acceleration, double jerk) {
    if (!is_limit(acceleration) || !is_limit(jerk)) return PlanResult::limit_not_positive;
    if (!std::isfinite(v0) || !std::isfinite(a0) || !std::isfinite(v1))
        return PlanResult::not_finite;

    const double missing = missing_velocity(v0, a0, v1, jerk);
    const double s = std::copysign(1.0, missing == 0 ? a0 : missing);
    VelocityRamp ramp;
    const double peak =
        missing == 0 ? s * a0 : reach_peak(ramp, v0, s, s * a0, s * missing, acceleration, jerk);
    const double last_velocity = ramp.count == 0 ? v0 : v1 - s * (peak * peak / (2 * jerk));
    append(ramp, peak / jerk, last_velocity, s * peak, -s * jerk);
    if (ramp.count > 0) {
        const Phase& last = ramp.phases[static_cast<std::size_t>(ramp.count - 1)];
        ramp.end.position = last.start.after(last.duration).position;
    }
    ramp.end.velocity = v1;
    if (!std::isfinite(ramp.duration) || !std::isfinite(ramp.end.position))
        return PlanResult::not_finite;
    *this = ramp;
    return PlanResult::ok;
}

MotionState VelocityRamp::at(double t) const {
    if (count == 0 || t >= duration) {
        const double beyond = t > duration ? t - duration : 0;
        return {end.position + end.velocity * beyond, end.velocity, 0, 0};
    }
    double dt = t > 0 ? t : 0;
    std::size_t i = 0;
    while (static_cast<int>(i) + 1 < count && dt >= phases[i].duration) dt -= phases[i++].duration;
    return phases[i].start.after(dt);
}

double ramp_duration(double dv, double acceleration, double jerk) {
    const double change = std::abs(dv);
    if (change >= acceleration * acceleration / jerk)
        return acceleration / jerk + change / acceleration;
    return 2 * std::sqrt(change / jerk);
}

}  // namespace lineshaft

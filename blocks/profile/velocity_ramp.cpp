#include "blocks/profile/velocity_ramp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lineshaft {
namespace {

bool is_limit(double x) {
    return x > 0 && x <= std::numeric_limits<double>::max();
}

/// A phase of no length leaves no trace: the next one takes its place.
int put(std::array<VelocityRamp::Phase, 4>& phases, int count, double duration,
        const MotionState& start) {
    phases[static_cast<std::size_t>(count)] = {duration, start};
    return count + (duration > 0 ? 1 : 0);
}

}  // namespace

PlanResult VelocityRamp::plan(double v0, double a0, double v1, double acceleration,
                              double deceleration, double jerk) {
    if (!is_limit(acceleration) || !is_limit(deceleration) || !is_limit(jerk))
        return PlanResult::limit_not_positive;
    if (!std::isfinite(v0) || !std::isfinite(a0) || !std::isfinite(v1))
        return PlanResult::not_finite;

    const double J = jerk;
    const double half_per_jerk = 0.5 / J;
    const double missing = missing_velocity(v0, a0, v1, half_per_jerk);
    const double s = std::copysign(1.0, missing == 0 ? a0 : missing);
    const double a = s * a0;
    const RampShape shape = ramp_shape(a, s * missing, s > 0 ? acceleration : deceleration, J);
    const double peak = shape.peak;

    const MotionState rise{0, v0, a0, s * shape.jerk};
    const MotionState hold{rise.after(shape.to_peak).position,
                           v0 + s * (std::abs(peak - a) * (peak + a) * half_per_jerk), s * peak, 0};
    const double fall_velocity =
        shape.to_peak > 0 || shape.hold > 0 ? v1 - s * (peak * peak * half_per_jerk) : v0;
    const MotionState fall{hold.after(shape.hold).position, fall_velocity, s * peak, -s * J};
    const double distance = fall.after(shape.to_zero).position;
    const double time = shape.to_peak + shape.hold + shape.to_zero;
    if (!std::isfinite(time) || !std::isfinite(distance)) return PlanResult::not_finite;

    count = put(phases, 0, shape.to_peak, rise);
    count = put(phases, count, shape.hold, hold);
    count = put(phases, count, shape.to_zero, fall);
    duration = time;
    end = {distance, v1, 0, 0};
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

#include "blocks/axis/profile_motion.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

MotionState ProfileMotion::at(double t, const Cam& cam) const {
    if (t < 0) return before_start(at(0, cam), t);
    const double x = cam.begin() + t / time_scale;
    const CurvePoint p = t < duration ? cam.at(x) : cam.last();
    const double k = scale / time_scale;
    if (of == ProfileOf::position)
        return {scale * p.y + offset, k * p.slope, k * p.bend / time_scale,
                k * p.twist / (time_scale * time_scale)};
    const double integral = scale * time_scale * cam.area(x) + offset * t;
    if (of == ProfileOf::velocity)
        return {start_position + integral, scale * p.y + offset, k * p.slope,
                k * p.bend / time_scale};
    const double twice =
        scale * time_scale * time_scale * cam.area_of_areas(x) + 0.5 * offset * t * t;
    return {start_position + start_velocity * t + twice, start_velocity + integral,
            scale * p.y + offset, k * p.slope};
}

MotionState ProfileMotion::end(const Cam& cam) const {
    const double last = scale * cam.points.back().y + offset;
    if (of == ProfileOf::position) return MotionState{last};
    const MotionState end = at(duration, cam);
    return {end.position, of == ProfileOf::velocity ? last : end.velocity};
}

Range ProfileMotion::positions(const Cam& cam) const {
    if (of != ProfileOf::position) {
        const Range way =
            of == ProfileOf::velocity
                ? cam.areas(time_scale * scale, time_scale * offset)
                : cam.areas_of_areas(time_scale * time_scale * scale,
                                     time_scale * time_scale * offset, time_scale * start_velocity);
        return {start_position + way.least, start_position + way.greatest};
    }
    const Range values = cam.values();
    const double one = scale * values.least + offset, other = scale * values.greatest + offset;
    return {std::min(one, other), std::max(one, other)};
}

bool ProfileMotion::keeps(const Dynamics& limits, const Cam& cam) const {
    constexpr double slightly_more = 1 + 1e-12;
    constexpr double nanosecond = 1e-9;
    const CamExtremes most = cam.extremes();
    const double k = std::abs(scale), T = time_scale;
    const double a = std::min(limits.acceleration, limits.deceleration) * slightly_more;
    const double v = limits.velocity * slightly_more, j = limits.jerk * slightly_more;
    if (of == ProfileOf::acceleration) {
        const Range gained = cam.areas(T * scale, T * offset);
        return std::abs(start_velocity + gained.least) <= v &&
               std::abs(start_velocity + gained.greatest) <= v &&
               k * most.y + std::abs(offset) <= a && k * most.slope / T <= j;
    }
    if (of == ProfileOf::velocity)
        return k * most.y + std::abs(offset) <= v && k * most.slope / T <= a &&
               k * most.bend / (T * T) <= j && k * most.slope_jump / T <= j * nanosecond;
    return k * most.slope / T <= v && k * most.bend / (T * T) <= a &&
           k * most.twist / (T * T * T) <= j && k * most.slope_jump / T <= a * nanosecond &&
           k * most.bend_jump / (T * T) <= j * nanosecond;
}

}  // namespace lineshaft

#include "blocks/axis/profile_motion.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

MotionState ProfileMotion::at(double t, const Cam& cam) const {
    if (t < 0) return before_start(at(0, cam), t);
    const double x = cam.begin() + t / time_scale;
    const CurvePoint p = t < duration ? cam.at(x) : cam.last();
    const double k = scale / time_scale;
    if (of_velocity == 0)
        return {scale * p.y + offset, k * p.slope, k * p.bend / time_scale,
                k * p.twist / (time_scale * time_scale)};
    return {start_position + scale * time_scale * cam.area(x) + offset * t, scale * p.y + offset,
            k * p.slope, k * p.bend / time_scale};
}

MotionState ProfileMotion::end(const Cam& cam) const {
    const double last = scale * cam.points.back().y + offset;
    return of_velocity == 0 ? MotionState{last} : MotionState{at(duration, cam).position, last};
}

Range ProfileMotion::positions(const Cam& cam) const {
    if (of_velocity != 0) {
        const Range way = cam.areas(time_scale * scale, time_scale * offset);
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
    if (of_velocity != 0)
        return k * most.y + std::abs(offset) <= v && k * most.slope / T <= a &&
               k * most.bend / (T * T) <= j && k * most.slope_jump / T <= j * nanosecond;
    return k * most.slope / T <= v && k * most.bend / (T * T) <= a &&
           k * most.twist / (T * T * T) <= j && k * most.slope_jump / T <= a * nanosecond &&
           k * most.bend_jump / (T * T) <= j * nanosecond;
}

}  // namespace lineshaft

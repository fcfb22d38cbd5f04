#include "blocks/circle/arc.hpp"

#include <algorithm>
#include <cmath>

#include <sleef.h>

namespace lineshaft {

namespace {

constexpr double most_steps = 1e9;

}  // namespace

Arc Arc::between(double radius, double start, double end, double step) {
    Arc arc;
    arc.radius = radius;
    arc.start = start;
    arc.direction = end < start ? -1 : 1;
    arc.sweep = std::abs(end - start);
    const double wanted = std::round(arc.sweep * radius / step);
    arc.steps = static_cast<std::int64_t>(std::clamp(wanted, 1.0, most_steps));
    return arc;
}

double Arc::theta(std::int64_t i) const {
    return sweep * static_cast<double>(i) / static_cast<double>(steps);
}

Point Arc::at(double theta, double rho) const {
    const double phi = start + direction * theta;
    return {rho * Sleef_cinz_sind1_u10purec(phi), rho * Sleef_cinz_cosd1_u10purec(phi)};
}

Point Arc::slope(double theta) const {
    const Point p = at(theta);
    return {direction * p.y, -direction * p.x};
}

Point Arc::chord_ratio(std::int64_t i) const {
    const Point from = at(theta(i - 1)), to = at(theta(i));
    return {(to.x - from.x) / step_angle(), (to.y - from.y) / step_angle()};
}

double Arc::sagitta() const {
    const double s = Sleef_cinz_sind1_u10purec(step_angle() / 4);
    return 2 * radius * s * s;
}

}  // namespace lineshaft

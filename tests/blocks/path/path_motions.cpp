#include "tests/blocks/path/path_motions.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft::test {

namespace {

bool above(double value, double limit) {
    return !(std::abs(value) <= limit * (1 + 1e-9));
}

/// The velocity with which a leg passes a place [u] of its way.
double velocity_at(const PathLeg& leg, double way) {
    double before = 0, after = leg.duration();
    for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (before + after);
        (leg.at(middle).position < way ? before : after) = middle;
    }
    return std::min(leg.at(before).velocity, leg.at(after).velocity);
}

}  // namespace

PathLimits wide_limits(const PathLimit& path) {
    PathLimits limits{path, {}};
    limits.axes.fill({1e9, 1e9, 1e9});
    return limits;
}

std::string violation(const PathMotion& m, const PathLimits& limits) {
    if (m.path.velocity < -1e-9 * limits.path.velocity) return "backwards";
    if (above(m.path.velocity, limits.path.velocity)) return "path velocity";
    if (above(m.path.acceleration, limits.path.acceleration)) return "path acceleration";
    if (above(m.path.jerk, limits.path.jerk)) return "path jerk";
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const auto axis = [&](const char* what) {
            return what + (" of axis " + std::to_string(i));
        };
        if (above(m.velocity[i], limits.axes[i].velocity)) return axis("velocity");
        if (above(m.acceleration[i], limits.axes[i].acceleration)) return axis("acceleration");
        if (above(m.jerk[i], limits.axes[i].jerk)) return axis("jerk");
    }
    return "";
}

bool passes_stop(const Path& path, std::span<const PathPiece> ring, const PathLimits& limits) {
    constexpr double rounding = 1e-9;
    for (std::uint64_t k = path.stretch; k < path.leg.goal; ++k) {
        const PathStretch& stretch = ring[k % ring.size()].stretch;
        const double way = stretch.end - path.leg.base;
        if (stretch.joint > 0 || !(way > 0)) continue;
        const double a = limits.path.acceleration;
        if (velocity_at(path.leg, way) > std::sqrt(2 * a * rounding * stretch.end)) return true;
    }
    return false;
}

}  // namespace lineshaft::test

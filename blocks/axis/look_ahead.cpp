#include "blocks/axis/look_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lineshaft {

namespace {

constexpr int halvings = 60;

/// The way of a ramp between two velocities that are `change` apart, the greater being `v`.
double way_of(double v, double change, double acceleration, double jerk) {
    return 0.5 * (v + (v - change)) * ramp_duration(change, acceleration, jerk);
}

/// Where J s^3 + 2 to s = way, s = sqrt(change / J): by Newton from the right, as it is convex.
double change_without_hold(double to, double way, double acceleration, double jerk) {
    double s = acceleration / jerk;
    for (int i = 0; i < 100; ++i) {
        const double next = s - (s * (jerk * s * s + 2 * to) - way) / (3 * jerk * s * s + 2 * to);
        if (!(next < s)) break;
        s = std::max(next, 0.0);
    }
    return jerk * s * s;
}

/// What a plan may miss that comes down to a velocity limit v first: there a rounding of the
/// velocity is worth the way of its square root.
double unsure(double v, const Dynamics& d) {
    return v * std::sqrt(64 * std::numeric_limits<double>::epsilon() * v / d.jerk);
}

/// The greatest v from which a motion comes down to `to`.
double greatest_start(double to, double way, const Dynamics& d) {
    const double direct = greatest_change(to, way, d.deceleration, d.jerk);
    if (direct <= d.velocity) return direct;
    const double sure = std::max(0.0, way - unsure(std::max(to, d.velocity), d));
    return greatest_change(to, sure, d.deceleration, d.jerk);
}

/// The least v from which every velocity up to `to` can be ramped up to it on the way.
double least_start(double to, double way, const Dynamics& d) {
    const double held = d.acceleration * (d.acceleration / d.jerk);
    const double longest = to / 1.5 <= held ? to / 1.5 : std::max(held, to - 0.5 * held);
    const auto fits = [&](double v) { return way_of(to, to - v, d.acceleration, d.jerk) <= way; };
    double low = to - longest, high = to;
    if (fits(low)) return 0;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (fits(middle) ? high : low) = middle;
    }
    return high;
}

/// Where the acceleration is held: a quadratic.
double change_with_hold(double to, double way, double acceleration, double jerk) {
    const double half = 0.5 * acceleration * (acceleration / jerk) + to;
    const double more = 2 * (way - to * (acceleration / jerk)) * acceleration;
    return more / (half + std::sqrt(half * half + more));
}

}  // namespace

double greatest_change(double to, double way, double acceleration, double jerk) {
    constexpr double rounded_down = 1 - 4 * std::numeric_limits<double>::epsilon();
    const double held = acceleration * (acceleration / jerk);
    const bool holds = way_of(to + held, held, acceleration, jerk) < way;
    const double change = holds ? change_with_hold(to, way, acceleration, jerk)
                                : change_without_hold(to, way, acceleration, jerk);
    return std::max(to, (to + change) * rounded_down);
}

Speeds entries(double way, const Speeds& exit, const Dynamics& d) {
    double greatest = greatest_start(exit.greatest, way, d);
    if (exit.least < exit.greatest)
        greatest = std::max(greatest, greatest_start(exit.least, way, d));
    if (exit.least == 0) return {0, greatest};
    const double up = way_of(exit.least, exit.least, d.acceleration, d.jerk);
    if (up < way) greatest = std::max(greatest, greatest_start(0, way - up, d));
    return {least_start(exit.least, way, d), greatest};
}

std::optional<double> greatest_exit(const MotionState& from, double way, const Speeds& exit,
                                    const Dynamics& d) {
    const double a = from.acceleration;
    const double settled = from.velocity + a * std::abs(a) / (2 * d.jerk);
    const auto reaches = [&](double v) {
        VelocityRamp ramp;
        if (settled <= std::max(v, d.velocity) &&
            ramp.plan(from.velocity, from.acceleration, v, d.acceleration, d.deceleration,
                      d.jerk) == PlanResult::ok &&
            ramp.end.position <= way)
            return true;
        PointMotion motion;
        return motion.begin({0, from.velocity, from.acceleration, 0}, way, v, d, {}) ==
                   PlanResult::ok &&
               !motion.turns(1);
    };
    if (reaches(exit.greatest)) return exit.greatest;
    double low = std::clamp(settled, exit.least, exit.greatest), high = exit.greatest;
    if (!reaches(low)) low = exit.least;
    if (!reaches(low)) return {};
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (reaches(middle) ? low : high) = middle;
    }
    return low;
}

}  // namespace lineshaft

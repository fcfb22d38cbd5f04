#include "blocks/profile/stepped_transition.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {
namespace {

constexpr double rounding = 1e-9;

/// How many of `count` steps a ramp of `per_step` > 0 stays below `height`.
double steps_below(double height, double per_step, double count) {
    return std::clamp(std::floor(height / per_step), 0.0, count);
}

struct Envelope {
    double limit = 0, from = 0, to = 0, per_step = 0;

    /// In step k = 1 .. n.
    double at(double k, double n) const {
        return std::min({limit, from + k * per_step, to + (n + 1 - k) * per_step});
    }

    /// What all n steps come to.
    double sum(double n) const {
        const double meet = std::floor((to - from + (n + 1) * per_step) / (2 * per_step));
        const double rising = steps_below(limit - from, per_step, std::clamp(meet, 0.0, n));
        const double falling = steps_below(limit - to, per_step, n - std::clamp(meet, 0.0, n));
        return rising * from + 0.5 * per_step * rising * (rising + 1) + falling * to +
               0.5 * per_step * falling * (falling + 1) + (n - rising - falling) * limit;
    }
};

struct Steps {
    double A = 0, D = 0, per_step = 0, quantum = 0;
    MotionState slave, guide;

    MotionState end(double n) const { return guide.after(n * quantum); }

    Envelope upper(double n) const {
        return {A, std::clamp(slave.acceleration, -D, A), std::clamp(end(n).acceleration, -D, A),
                per_step};
    }

    /// Mirrored.
    Envelope lower(double n) const {
        const Envelope up = upper(n);
        return {D, -up.from, -up.to, per_step};
    }

    /// The weight of the upper envelope; outside of 0..1: n steps do not serve.
    double weight(double n) const {
        const Envelope up = upper(n);
        const double reach = (n + 1) * per_step * (1 + rounding);
        if (!(std::abs(up.to - up.from) <= reach)) return -1;
        const double least = -lower(n).sum(n), greatest = up.sum(n);
        const double sum = (end(n).velocity - slave.velocity) / quantum;
        const double of_velocities =
            0x1p-48 * (std::abs(slave.velocity) + std::abs(end(n).velocity));
        const double slack =
            rounding * std::max(std::abs(least), std::abs(greatest)) + of_velocities / quantum;
        if (!(sum >= least - slack && sum <= greatest + slack)) return -1;
        return greatest > least ? std::clamp((sum - least) / (greatest - least), 0.0, 1.0) : 0;
    }

    /// The acceleration of the first of n steps.
    double acceleration(double n) const {
        const double least = -lower(n).at(1, n), greatest = upper(n).at(1, n);
        return least + weight(n) * (greatest - least);
    }

    bool serves(double n) const { return weight(n) >= 0; }

    std::optional<double> least_count() const {
        double most = 1, too_few = 0;
        while (!serves(most)) {
            if (most >= static_cast<double>(most_transition_steps)) return {};
            too_few = most;
            most *= 2;
        }
        while (most - too_few > 1) {
            const double middle = std::floor(0.5 * (too_few + most));
            (serves(middle) ? most : too_few) = middle;
        }
        return most;
    }
};

}  // namespace

std::optional<TransitionStep> first_step(const TransitionLimits& limits, double quantum,
                                         const MotionState& slave, const MotionState& guide,
                                         std::int64_t expected) {
    const double A = limits.acceleration, D = limits.deceleration;
    Steps steps{A, D, std::min(limits.jerk * quantum, A + D), quantum, slave, guide};
    std::optional<double> count = static_cast<double>(expected);
    if (expected < 1 || !steps.serves(*count)) count = steps.least_count();
    if (!count) {
        steps.guide.jerk = 0;
        count = steps.least_count();
    }
    if (!count) {
        steps.guide.acceleration = 0;
        count = steps.least_count();
    }
    if (!count) return {};
    return TransitionStep{steps.acceleration(*count), static_cast<std::int64_t>(*count) - 1};
}

}  // namespace lineshaft

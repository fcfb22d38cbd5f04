#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "blocks/profile/any_state.hpp"

namespace lineshaft {

/// A motion as its jerks, with the acceleration at the end of each.
struct Steps {
    struct Step {
        double duration, jerk, acceleration;
    };
    std::array<Step, MotionPlan::most_phases + 1> list;
    std::size_t count = 0;

    void add(double time, double jerk, double acceleration) {
        list.data()[count] = {time, jerk, acceleration};
        count += time > 0 ? 1 : 0;
    }
};

/// A motion under way: each phase from where the one before it ends. What takes no time leaves no
/// trace.
struct Track {
    /// Two numbers written and read as one: halves that are read as a whole make the processor
    /// wait.
    typedef double Pair [[gnu::vector_size(16)]];

    /// As it stands in a plan, and the position counted from where the motion begins.
    struct Phase {
        Pair begin_duration, position_velocity, acceleration_jerk;
        double x;
    };
    static_assert(offsetof(Phase, x) == sizeof(MotionPlan::Phase));

    Phase* next;  ///< where the next phase is written
    double origin, x = 0, v, a;
    double duration = 0, end = 0;  ///< the sum of all times, and where the next phase begins
    double path = 0, fastest;

    Track(const MotionState& from, Phase* phases)
        : next(phases),
          origin(from.position),
          v(from.velocity),
          a(from.acceleration),
          fastest(std::abs(from.velocity)) {}

    void add(double time, double jerk, double acceleration) {
        const double t = std::max(time, 0.0);
        *next = {Pair{end, t}, Pair{origin + x, v}, Pair{a, jerk}, x};
        const bool lasts = time > 0;
        next += lasts;
        duration += time;
        end += t;
        const double way = x + t * (v + t * (a * 0.5 + t * (jerk * (1.0 / 6))));
        path += std::abs(way - x);
        x = way;
        v += t * (a + t * (jerk * 0.5));
        fastest = std::max(fastest, std::abs(v));
        a = lasts ? acceleration : a;
    }
};

}  // namespace lineshaft

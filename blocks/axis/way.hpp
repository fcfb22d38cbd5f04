#pragma once

#include <array>

#include "blocks/axis/axis_motion.hpp"
#include "blocks/profile/polynomial.hpp"

namespace lineshaft {

/// Positions between which a motion of constant jerk stays for `duration` [s].
Range positions_of(const MotionState& start, double duration);

/// What an axis goes through from a moment on: the sum of motions that have been planned.
class Way {
  public:
    explicit Way(const Moment& from) : from_(from) {}

    /// The motions must live as long as the way.
    void add(const PointMotion& motion);
    void add(const VelocityMotion& motion);

    /// Until all have ended.
    double duration() const { return duration_; }
    MotionState at(double t) const;
    /// In closed form, from the beginning to t [s].
    Range positions(double until) const;

  private:
    struct Part {
        const MotionPlan* plan = nullptr;
        const VelocityMotion* ramp = nullptr;
        double begun = 0;  ///< before `from_` [s]
    };
    static constexpr std::size_t most_parts = 2;

    void mark(double t);

    Moment from_;
    std::array<Part, most_parts> parts_{};
    std::size_t count_ = 0;
    /// Where a phase may end, in no order.
    std::array<double, most_parts*(MotionPlan::most_phases + 1)> marks_{};
    std::size_t marked_ = 0;
    double duration_ = 0;
};

}  // namespace lineshaft

#include "blocks/axis/way.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lineshaft {

namespace {

void widen(Range& range, double position) {
    range = {std::min(range.least, position), std::max(range.greatest, position)};
}

double between(const Moment& earlier, const Moment& later) {
    return earlier.until(later.time) + later.later;
}

}  // namespace

/// The velocity v + a t + j t^2/2 passes zero at -q/j and -2v/q, q = a + sign(a) sqrt(a^2 - 2jv).
Range positions_of(const MotionState& s, double duration) {
    Range range{s.position, s.position};
    widen(range, s.after(duration).position);
    const double square = s.acceleration * s.acceleration - 2 * s.jerk * s.velocity;
    if (!(square >= 0)) return range;
    const double q = s.acceleration + std::copysign(std::sqrt(square), s.acceleration);
    for (const double turn : {s.jerk != 0 ? -q / s.jerk : 0, q != 0 ? -2 * s.velocity / q : 0})
        if (turn > 0 && turn < duration) widen(range, s.after(turn).position);
    return range;
}

void Way::mark(double t) {
    if (t > 0) marks_[marked_++] = t;
    duration_ = std::max(duration_, t);
}

void Way::add(const PointMotion& motion) {
    assert(count_ < most_parts);
    const double begun = between(motion.start, from_);
    parts_[count_++] = {&motion.plan, nullptr, begun};
    for (std::size_t i = 1; i < motion.plan.count; ++i) mark(motion.plan.phases[i].begin - begun);
    mark(motion.plan.duration - begun);
}

void Way::add(const VelocityMotion& motion) {
    assert(count_ < most_parts);
    double t = -between(motion.start, from_);
    parts_[count_++] = {nullptr, &motion, -t};
    for (int i = 0; i < motion.ramp.count; ++i)
        mark(t += motion.ramp.phases[static_cast<std::size_t>(i)].duration);
}

MotionState Way::at(double t) const {
    MotionState sum;
    for (std::size_t i = 0; i < count_; ++i) {
        const Part& part = parts_[i];
        MotionState s =
            part.plan ? part.plan->at(part.begun + t) : part.ramp->ramp.at(part.begun + t);
        if (part.ramp) s.position += part.ramp->start_position;
        sum = {sum.position + s.position, sum.velocity + s.velocity,
               sum.acceleration + s.acceleration, sum.jerk + s.jerk};
    }
    return sum;
}

/// A phase is looked up in its middle: its ends are rounded.
Range Way::positions(double until) const {
    auto marks = marks_;
    const auto end = marks.begin() + static_cast<std::ptrdiff_t>(marked_);
    std::sort(marks.begin(), end);
    const double start = at(0).position;
    Range range{start, start};
    double t = 0;
    for (auto mark = marks.begin(); t < until; ++mark) {
        const double next = mark < end ? std::min(*mark, until) : until;
        if (next > t) {
            const double half = 0.5 * (next - t);
            const Range passed = positions_of(at(t + half).after(-half), next - t);
            widen(range, passed.least);
            widen(range, passed.greatest);
        }
        t = next;
    }
    widen(range, at(until).position);
    return range;
}

}  // namespace lineshaft

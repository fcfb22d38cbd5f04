#include "blocks/profile/constant_jerk.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

namespace {

constexpr int most = 1'000'000;  // samples of a phase

}  // namespace

template <class Real>
bool ConstantJerk<Real>::begin(const ConstantJerkLimits<Real>& limits, Real distance) {
    const Real T = period_ = limits.period;
    const Real t1 = limits.acceleration / limits.jerk;
    Real amax = std::min(limits.acceleration, limits.velocity / t1);
    Real beta = amax < limits.acceleration ? amax / t1 : limits.jerk;
    Real t2 = std::max(limits.velocity / amax - t1, Real(0));
    Real t4 = 0;
    const Real s1 = 2 * amax * t1 * t1;
    const Real s2 = limits.velocity * (2 * t1 + t2);
    if (distance <= s1) {
        kind_ = ConstantJerkKind::no_constant_acceleration;
        amax = amax * distance / s1;
        beta = beta * distance / s1;
        t2 = 0;
    } else if (distance < s2) {
        kind_ = ConstantJerkKind::no_cruise;
        t2 = (std::sqrt(t1 * t1 + 4 * distance / amax) - 3 * t1) / 2;
    } else {
        kind_ = ConstantJerkKind::full;
        t4 = distance / limits.velocity - 2 * t1 - t2;
    }
    const Real k1 = t1 / T, k2 = t2 / T;
    samples_ = {0, k1, k2, k1, t4 / T, k1, k2, k1};
    acceleration_step_ = amax * T;
    jerk_step_ = Real(0.5) * beta * T * T;
    velocity_ = 0;
    const bool good = std::ranges::all_of(samples_, [](Real k) { return k >= 0 && k <= most; });
    phase_ = good ? 1 : 8;
    k_ = 1;
    return good;
}

template <class Real>
bool ConstantJerk<Real>::next(ConstantJerkSample<Real>& out) {
    while (phase_ <= 7 && !(static_cast<Real>(k_) <= samples_[static_cast<std::size_t>(phase_)])) {
        ++phase_;
        k_ = 1;
    }
    if (phase_ > 7) return false;
    const Real before = velocity_;
    velocity_ = velocity_ + increment();
    ++k_;
    out = {before, velocity_, (before + velocity_) * period_ / 2};
    return true;
}

template <class Real>
Real ConstantJerk<Real>::increment() const {
    const Real by_jerk = jerk_step_ * static_cast<Real>(2 * k_ - 1);
    switch (phase_) {
        case 1:
            return by_jerk;
        case 2:
            return acceleration_step_;
        case 3:
            return acceleration_step_ - by_jerk;
        case 5:
            return -by_jerk;
        case 6:
            return -acceleration_step_;
        case 7:
            return by_jerk - acceleration_step_;
        default:
            return 0;
    }
}

template class ConstantJerk<float>;
template class ConstantJerk<double>;

}  // namespace lineshaft

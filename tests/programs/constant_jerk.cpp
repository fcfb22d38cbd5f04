#include "tests/programs/constant_jerk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lineshaft {

namespace {

constexpr int most = 1'000'000;  // samples of a phase

/// Rounding of a quotient or a sum of `samples`.
template <class Real>
Real slack(Real samples) {
    return 16 * std::numeric_limits<Real>::epsilon() * samples;
}

}  // namespace

template <class Real>
bool ConstantJerk<Real>::begin(const ConstantJerkLimits<Real>& limits, Real distance,
                               ConstantJerkPhases phases) {
    const bool whole = phases == ConstantJerkPhases::whole;
    const Real T = period_ = limits.period;
    Real t1 = limits.acceleration / limits.jerk;
    if (whole) t1 = std::ceil(t1 / T - slack(t1 / T)) * T;
    Real amax = std::min(limits.acceleration, limits.velocity / t1);
    Real beta = whole || amax < limits.acceleration ? amax / t1 : limits.jerk;
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
    const Real scale = whole ? fill_whole_samples(limits, amax, distance) : Real(1);
    acceleration_step_ = scale * amax * T;
    jerk_step_ = scale * Real(0.5) * beta * T * T;
    velocity_ = 0;
    const bool good = std::ranges::all_of(samples_, [](Real k) { return k >= 0 && k <= most; });
    phase_ = good ? 1 : 8;
    k_ = 1;
    return good;
}

/// Returns the share of the acceleration with which they come to the distance.
template <class Real>
Real ConstantJerk<Real>::fill_whole_samples(const ConstantJerkLimits<Real>& limits,
                                            Real acceleration, Real distance) {
    const bool cruises = kind_ == ConstantJerkKind::full;
    const Real k1 = std::round(samples_[1]);
    const Real k2 =
        cruises ? std::ceil(samples_[2] - slack(k1 + samples_[2])) : std::round(samples_[2]);
    const Real by_acceleration = acceleration * period_ * (k1 + k2);
    const Real cruise =
        period_ * (cruises ? std::min(by_acceleration, limits.velocity) : by_acceleration);
    const Real missing = distance / cruise - (2 * k1 + k2);
    const Real k4 = std::max(std::ceil(missing - slack(distance / cruise)), Real(0));
    samples_ = {0, k1, k2, k1, k4, k1, k2, k1};
    return distance / (by_acceleration * period_ * (2 * k1 + k2 + k4));
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

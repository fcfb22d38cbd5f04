#pragma once

#include <array>
#include <cstdint>

namespace lineshaft {

/// The limits of a constant-jerk move and its sampling period, in any one unit of length and s.
template <class Real>
struct ConstantJerkLimits {
    Real acceleration = 1, jerk = 1, velocity = 1;
    Real period = Real(0.05);
};

enum class ConstantJerkKind : std::int64_t { none, no_constant_acceleration, no_cruise, full };

/// What becomes of a part of a sample at a phase's end.
enum class ConstantJerkPhases : std::int64_t { cut, whole };

/// One sample: velocity at its start and end, and the distance by the trapezoid between them.
template <class Real>
struct ConstantJerkSample {
    Real start_velocity = 0, end_velocity = 0, distance = 0;
};

/// The leading axis' samples; programs/paper/jerk_line.st has the formulas.
template <class Real>
class ConstantJerk {
  public:
    /// Limits and distance must be above 0. False, and no sample, if a phase is no finite number of
    /// samples, or more than a million.
    bool begin(const ConstantJerkLimits<Real>& limits, Real distance,
               ConstantJerkPhases phases = ConstantJerkPhases::cut);

    /// The next sample; false after the last.
    bool next(ConstantJerkSample<Real>& out);

    ConstantJerkKind kind() const { return kind_; }
    std::int64_t phase() const { return phase_; }  ///< 1 to 7; 8: ended

  private:
    Real fill_whole_samples(const ConstantJerkLimits<Real>& limits, Real acceleration,
                            Real distance);
    Real increment() const;

    ConstantJerkKind kind_ = ConstantJerkKind::none;
    std::int64_t phase_ = 8;
    std::int64_t k_ = 1;
    std::array<Real, 8> samples_{};  ///< k_i of phase i
    Real acceleration_step_ = 0;     ///< amax T
    Real jerk_step_ = 0;             ///< 1/2 beta T^2
    Real velocity_ = 0;
    Real period_ = 0;
};

extern template class ConstantJerk<float>;
extern template class ConstantJerk<double>;

}  // namespace lineshaft

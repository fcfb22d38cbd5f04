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

/// Two-axis linear interpolation with constant jerk: the leading axis' seven phases in increments
/// of one sampling period T, rest to rest (eqs. (1) to (24), section 1.5). k counts from 1 inside
/// each phase:
///
///     t1 = amax / beta, t2 = vmax / amax - t1, t4 = s / vmax - 2 t1 - t2, k_i = t_i / T
///     phases 1, 5: dv = +-1/2 beta T^2 (2k - 1)
///     phases 2, 6: dv = +-amax T
///     phases 3, 7: dv = +-(amax T - 1/2 beta T^2 (2k - 1))
///     phase 4:     dv = 0
///     ds = (v_before + v_after) T / 2
///
/// A phase runs while k <= k_i, so a part of a sample is `cut`, as in the paper. Three kinds by
/// distance, with s1 = 2 amax t1^2 and s2 = vmax (2 t1 + t2), which the paper does not give:
///     s <= s1       acceleration and jerk times s / s1, no phases 2, 4, 6: always takes 4 t1
///     s1 < s < s2   t2' from amax (t1 + t2') (2 t1 + t2') = s, no phase 4
///     s >= s2       as above
/// vmax below amax t1 has no phase 2 either: then amax and beta are lowered to vmax / t1, vmax /
/// t1^2, which keeps t1. `Real` is float, as the controller reckons, or double.
///
/// Phases that are `whole` lose nothing (not in the paper): k1 is rounded up, k2 to the nearest, or
/// up in a full move, as many whole samples of phase 4 as the rest of the distance needs follow,
/// and acceleration and jerk are multiplied by s / s(k1, k2, k4) <= 1, with s(k1, k2, k4) = amax
/// T^2 (k1 + k2) (2 k1 + k2 + k4). The increments then come to s, and vmax is kept; the move takes
/// less than 2 samples more than 4 t1 + 2 t2 + t4 if t1 is a multiple of T.
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

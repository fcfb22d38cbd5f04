#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

/// Jerk-limited move along a path from Vs to Ve, acceleration zero at both ends (Liu 2023): seven
/// segments of jerk +J, 0, -J, 0, -J, 0, +J, in the shortest time. With tm = A/J and c = A^2/J a
/// ramp between two velocities Va and Vb, dv apart, is
///
///     trapezoidal if dv > c:   jerk time tm,           hold dv/A - tm
///     triangular otherwise:    jerk time sqrt(dv/J),   hold 0
///
/// and its length is (Va + Vb) (jerk time + hold/2), equation (9) of the paper. Two lengths part
/// three kinds of move: L1 = ramp(Vs, Ve) (10) and L2 = ramp(Vs, Vm) + ramp(Vm, Ve) (11).
/// Below, s is a jerk time and y = tm + hold; on the left the number of `equation` and the paper's.
///
/// L < L1, one ramp only, Ve is not reached (L within rounding of L1 does reach it). V is Vs; upper
/// signs if Ve >= Vs, lower signs if not; the velocity reached is V +- A y or V +- J s^2:
///
///     1 (12), 3 (14)    A y^2 +- (2V +- c) y -+ 2 (L - V tm) = 0
///     2 (13), 4 (15)    J s^3 +- 2V s -+ L = 0
///
/// The length of a deceleration is greatest where it ends at V/3, at c/2 if it is trapezoidal
/// there; before that comes the lesser of two positive roots.
///
/// L >= L2, cruise at Vm:
///
///     5 to 8 (16..19)   T4 = (L - L2) / Vm
///
/// Between, a peak below Vm. Reversed in time a move has the same length, so only the slower end lo
/// and the faster end hi matter, D = hi - lo. The ramp at hi has y or s, the ramp at lo follows:
///
///     9 (21)            A y^2 + (2 hi + c) y - (L - hi tm - (lo + hi)(tm + D/A)/2) = 0,
///                       hold at lo = hold at hi + D/A
///     10 (23)           J/(2 tm) s^4 + J s^3 + (hi + c/2)/tm s^2 + 2 hi s
///                       - (L - (lo + hi)(tm + D/A)/2) = 0,  hold at lo = (D + J s^2)/A - tm
///     11 (30)           J/4 m^4 + (lo + hi) m^2 - L m - D^2/(4J) = 0,
///                       m the sum of the two jerk times, D/(J m) their difference
///
/// No unknown is the peak velocity: the length has a square-root singularity where the peak meets
/// hi. The quadratics are solved in closed form, written without cancellation. The cubics and
/// quartics go by Householder's iteration of the fourth order, kept in a bracket, from a start
/// within some percent: two steps, seldom three. The paper's closed forms (Shengjin's, Ferrari's:
/// tests/blocks/profile/closed_form.hpp) lost by measurement, over 600,000 random problems:
///
///     equation                         2 cubic   4 cubic   10 quartic   11 quartic
///     closed form, length p99 [ulp]    2.3e6     2.7e2     2.7e4        4.1e16, 1.2 % no root
///     here, length p99 [ulp]           2.4       1.3       3.3          3.4
///     closed form, the root [ns]       43        41        72           132
///     here, the whole plan [ns]        54        59        85           83
///
/// (Least of many runs on one machine.) Over 5 million random problems, the times run in 113 bits,
/// the length is off by 2.6 ulp of L at the 99th percentile and 7.8 at most, the end velocity
/// by 3.5 ulp of Vm at most, the duration by 2.4e-15 of the optimum at most; limits are kept to
/// 6e-16.
///
/// A length below 1e-100 takes no time. Quantities so great or small that a result overflows are
/// refused as not_finite.
struct SevenSegment {
    double Vs = 0, Ve = 0;  ///< start and end velocity [u/s], 0 <= Vs, Ve <= Vm
    double Vm = 1;          ///< velocity limit [u/s], > 0
    double A = 1;           ///< acceleration limit, both ways [u/s^2], > 0
    double J = 1;           ///< jerk limit [u/s^3], > 0
    double L = 0;           ///< path length [u], >= 0
};

/// What a move looks like. A ramp is trapezoidal if it reaches A and holds it, else triangular.
/// `rising` is Ve >= Vs, `falling` Ve < Vs; both, first, second, neither: the trapezoidal ramps.
enum class MoveKind : std::int64_t {
    accelerate_trapezoidal,
    accelerate_triangular,
    decelerate_trapezoidal,
    decelerate_triangular,
    cruise_rising_both,
    cruise_rising_first,
    cruise_rising_neither,
    cruise_falling_both,
    cruise_falling_second,
    cruise_falling_neither,
    peak_rising_both,
    peak_rising_first,
    peak_rising_neither,
    peak_falling_both,
    peak_falling_second,
    peak_falling_neither,

};

inline constexpr std::string_view move_kind_names[] = {
    "accelerate_trapezoidal", "accelerate_triangular", "decelerate_trapezoidal",
    "decelerate_triangular",  "cruise_rising_both",    "cruise_rising_first",
    "cruise_rising_neither",  "cruise_falling_both",   "cruise_falling_second",
    "cruise_falling_neither", "peak_rising_both",      "peak_rising_first",
    "peak_rising_neither",    "peak_falling_both",     "peak_falling_second",
    "peak_falling_neither"};

inline constexpr int move_kinds = 16;  ///< of seven segments

std::string_view name(MoveKind kind);

/// Number of the equation that gives the kind its times, 1 to 11.
int equation(MoveKind kind);

struct SevenSegmentPlan {
    std::array<double, 7> T{};         ///< durations of the segments, jerk +J 0 -J 0 -J 0 +J [s]
    std::array<double, 8> begin{};     ///< time of each segment's start, and of the end [s]
    std::array<MotionState, 7> start;  ///< state at the start of each segment
    double duration = 0;               ///< [s]
    double peak = 0;                   ///< greatest velocity [u/s]
    MotionState end;                   ///< end.position is exactly L; end.velocity is exactly Ve
                                       ///< where L suffices, else what is reached at L
    MoveKind kind = MoveKind::accelerate_triangular;
    bool reaches_Ve = true;  ///< false: L is too short for Vs -> Ve

    MotionState at(double t) const;  ///< clamped to 0..duration

    /// What the times miss L by [u], run from Vs one after the other in extended precision: the
    /// plan's error, not that of at(), which is exact at both ends.
    double displacement_error() const;
};

/// On failure `out` is unchanged.
PlanResult plan(const SevenSegment& problem, SevenSegmentPlan& out);

}  // namespace lineshaft

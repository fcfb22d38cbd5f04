#pragma once

#include <array>
#include <string_view>

#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

/// Jerk-limited move along a path from Vs to Ve, acceleration zero at both ends (Liu 2023).
struct SevenSegment {
    double Vs = 0, Ve = 0;  ///< start and end velocity [u/s], 0 <= Vs, Ve <= Vm
    double Vm = 1;          ///< velocity limit [u/s], > 0
    double A = 1;           ///< acceleration limit, both ways [u/s^2], > 0
    double J = 1;           ///< jerk limit [u/s^3], > 0
    double L = 0;           ///< path length [u], >= 0
};

/// What a move looks like. A ramp is trapezoidal if it reaches A and holds it, else triangular.
/// `rising` is Ve >= Vs, `falling` Ve < Vs; both, first, second, neither: the trapezoidal ramps.
enum class MoveKind {
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

inline constexpr int move_kinds = 16;

std::string_view name(MoveKind kind);

/// Number of the equation that gives the kind its times, 1 to 11.
int equation(MoveKind kind);

struct SevenSegmentPlan {
    std::array<double, 7> T{};         ///< durations of the segments, jerk +J 0 -J 0 -J 0 +J [s]
    std::array<double, 7> begin{};     ///< time of each segment's start [s]
    std::array<MotionState, 7> start;  ///< state at the start of each segment
    double duration = 0;               ///< [s]
    double peak = 0;                   ///< greatest velocity [u/s]
    MotionState end;                   ///< end.position is exactly L; end.velocity is exactly Ve
                                       ///< where L suffices, else what is reached at L
    MoveKind kind = MoveKind::accelerate_triangular;
    bool reaches_Ve = true;  ///< false: L is too short for Vs -> Ve

    MotionState at(double t) const;  ///< clamped to 0..duration
};

/// On failure `out` is unchanged.
PlanResult plan(const SevenSegment& problem, SevenSegmentPlan& out);

}  // namespace lineshaft

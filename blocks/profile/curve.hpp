#pragma once

#include <cstdint>

#include "blocks/profile/forecast.hpp"
#include "blocks/profile/polynomial.hpp"
#include "blocks/profile/transition.hpp"

namespace lineshaft {

/// A slave over its master at one place: y(x) with its derivatives.
struct CurvePoint {
    double y = 0, slope = 0, bend = 0, twist = 0;  ///< y, y', y'', y''' [u/m^n]

    /// The slave's motion: v = y' vm, a = y'' vm^2 + y' am, j = y''' vm^3 + 3 y'' vm am + y' jm.
    MotionState led_by(const MotionState& master) const;
};

/// From one state to another by a polynomial of the fifth order over the master, so both are met
/// exactly however the master moves in between.
struct SyncCurve {
    double begin = 0, length = 0;  ///< master's position at its start, and way to its end [m]
    Polynomial<5> y;               ///< over the share of the way, 0..1

    /// Both with y, y', y''. `length` may be below 0, but not 0.
    static SyncCurve between(double begin, double length, const CurvePoint& from,
                             const CurvePoint& to);

    /// On a straight line before its start; x in the direction of the way.
    CurvePoint at(double x) const;
    double share(double x) const { return (x - begin) / length; }

    /// Whether the slave turns round on the way of a master that does not.
    bool turns() const;
};

/// Why a curve is not taken: a limit that it does not keep, or no beginning.
enum class CurveFault : std::int64_t { none, velocity, acceleration, jerk, standing_master };

/// Which limit it is, what it would have to be, and what it is: 0 where that is not known.
struct Shortage {
    CurveFault limit = CurveFault::none;
    double needed = 0, allowed = 0;
};

/// Whether the slave keeps its limits at every instant from the master's state `now` to the end of
/// the curve, or to where the master turns or is at `last`, if the master keeps its acceleration.
/// The squares of the slave's velocity and jerk and its acceleration are polynomials over the way
/// then: the master has v^2 = v0^2 + 2 a (x - x0).
CurveFault check(const SyncCurve& curve, const MotionState& now, const TransitionLimits& limits,
                 double last);
CurveFault check(const SyncCurve& curve, const MotionState& now, const TransitionLimits& limits);

/// The same of a master that moves as foreseen. Where its jerk is not 0 the slave is looked at in
/// 32 moments of a piece.
CurveFault check_ahead(const SyncCurve& curve, const Forecast& master,
                       const TransitionLimits& limits);

/// Whether a state that is `time` [s] later than another one can be that of a motion within limits,
/// by its velocity, its acceleration and the mean of its jerk.
CurveFault check_step(const MotionState& before, const MotionState& now, double time,
                      const TransitionLimits& limits);

/// Where slave and master stand when they begin to approach: y' = v / vm, y'' = (a - y' am) / vm^2.
/// A slave that stands begins with both 0. False where the slave moves and the master stands.
bool start_of_curve(const MotionState& slave, const MotionState& master, CurvePoint& out);

/// Which of the equal positions of a modulo slave it meets its master at.
enum class SyncMode : std::int64_t {
    shortest,   ///< with the least change of its velocity
    catch_up,   ///< ahead of that, or at it
    slow_down,  ///< behind that, or at it
};

inline constexpr std::string_view sync_mode_names[] = {"mcShortest", "mcCatchUp", "mcSlowDown"};

/// The position `goal` + n `modulo` where the slave arrives after the way `length` of its master
/// from `from` to the slope `slope`; `natural` is where an even change of the slope leads.
double sync_position(const CurvePoint& from, double slope, double length, double goal,
                     double modulo, SyncMode mode);

}  // namespace lineshaft

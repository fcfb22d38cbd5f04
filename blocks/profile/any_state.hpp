#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "blocks/profile/motion_limits.hpp"
#include "blocks/profile/velocity_ramp.hpp"

namespace lineshaft {

/// From any state (p0, v0, a0) to a position pf with velocity vf and acceleration 0, in the least
/// time: velocity in Vmin..V, acceleration in -D..A, jerk in -J..J.
///
/// The direct ramp brings (v0, a0) to vf in the least time (velocity_ramp.hpp) and ends at d0. Let
/// F+ be the fullest motion towards V: jerk +J up to A, held, down to reach V, cruise; F- its
/// mirror image towards Vmin. Leave F at some moment by the direct ramp from there. Then
///     the sign of pf - d0 decides between F+ and F-, and
///     the first moment at which that ends at pf is the optimum (README.md says why).
///
/// Mirrored so that pf > d0, and with tau = a0/J: the state lies on a parabola of jerk +J that
/// begins at acceleration 0 in the virtual point
///     vb = v0 - a0 tau/2,    the way left from there L = (pf - p0) + tau (v0 - a0 tau/3).
/// q is the jerk time up from the virtual point, r the one down to vf, alpha = A/J, delta = D/J,
/// Dv = vb - vf, S = vb + vf; the peak velocity is vp = vb + J q^2 = vf + J r^2 where no ramp
/// holds. q < 0 is a dip: F is left before the acceleration has come to zero.
///
/// The direct ramp has a q or an r of its own (the other is tau, or 0) and ends at d0. What is
/// added to it, or to the border of two shapes that lies last before the goal, is the unknown, and
/// miss the way from there to the goal: no digits are lost beside great q, r and L. With the peak
/// velocity v of what it is added to, and m = q + r:
///
///     ramps up / down              equation
///     triangular / triangular      J/4 y^4 + J m y^3 + (2v + J (q^2 + 6qr + r^2)/2) y^2
///                                  + m (2v + Jqr) y = miss (m + y),  for m + y
///     triangular / trapezoidal     J/(2 delta) x^4 + J (1 + 2q/delta) x^3
///                                  + (v/delta + J (2q^2/delta + 3q + delta/2)) x^2
///                                  + (1 + q/delta) (2v + Dq) x = miss,  for q + x
///     trapezoidal / triangular     the same in r, with A for D
///     trapezoidal / trapezoidal    quadratic in what is added to v
///     cruise at V                  (L - way of both ramps) / V
///
/// vp passes the borders vb + A^2/J (A is held), vf + D^2/J (D is held) and V; the way at them
/// tells the shape. For vf >= 0 the way grows with the moment of leaving, and the root is the only
/// one. For vf < 0 it has a greatest value in the dip at most,
///     triangular     J m^2 = (-2 S - sqrt(4 S^2 - 3 Dv^2))/3
///     trapezoidal    J q^2 + D q/2 + vb = 0, the smaller root
/// before which the goal is hit or after which there is one crossing. The quartics go by bracketed
/// steps of the fourth order (peak_equations.hpp).
///
/// The optimum jumps at pf = d0, so a tolerance is part of the definition: the direct ramp is taken
/// if |pf - d0| is within `tolerance` ulp of max(|p0|, |pf|, path), and a velocity or acceleration
/// within as much of its limit keeps it. 64 is for one plan; a controller that plans anew each scan
/// from its own rounded state takes 1024. What rounding leaves is spread over the first
/// thousandth of the duration, so that every later state leads to the goal: over all of it, what
/// each of ten thousand plans adds would come to more than the tolerance.
///
/// For a given duration the motions of F+ and F- are closed forms: what is added to the ramps is
/// y = u/2 if u is what is added to the duration, a quadratic in x, or linear in v. All limits are
/// convex, so a mean of both keeps them, and its weight is linear in pf. Where pf lies outside of
/// both the duration is blocked; the next feasible one is the next crossing of the side that is
/// short.

/// How a state outside its limits comes back: `gentle` joins the velocity limit tangentially and
/// does not fall below it on the way to a far goal; `soonest` brakes until the limit is kept, from
/// where the velocity may fall further. Soonest is when the limits are kept again for good, not the
/// arrival, which may be later than the gentle one. An acceleration outside its limits comes back
/// first, unless a velocity limit is passed by that; a velocity above V that must fall past Vmin is
/// brought back from there.
enum class Entry : std::int64_t { gentle, soonest };

struct Goal {
    double position = 0;  ///< pf [u]
    double velocity = 0;  ///< vf [u/s], in Vmin..V
};

struct PlanOptions {
    Entry entry = Entry::gentle;
    double tolerance = 64;  ///< [ulp], >= 0
};

/// Phases of constant jerk: 12 at most in the least time, 24 in a given one. Some last as long as a
/// rounding does: they free a long cruise or hold of the acceleration that rounding has left.
struct MotionPlan {
    struct Phase {
        double begin = 0, duration = 0;  ///< [s]; duration > 0
        MotionState start;               ///< its jerk lasts for the phase
    };

    static constexpr std::size_t most_phases = 24;
    static constexpr double spread =
        1024;  ///< in this part of the duration `missed` is made up for

    std::size_t count = 0;
    double duration = 0;  ///< [s]
    double missed = 0;    ///< what rounding has left of the way [u] ...
    double haste = 0;     ///< ... and how fast it is made up for [1/s]
    MotionState end;      ///< exactly the goal
    std::array<Phase, most_phases> phases{};

    /// State t seconds after the start; t < 0 is taken as 0; after the end: constant velocity.
    MotionState at(double t) const;

    /// The same for times that mostly rise: `phase` is where the last one was found, 0 at first.
    MotionState at(double t, std::size_t& phase) const {
        const bool is_there = t > 0 && t < duration && phase + 1 < count &&
                              t >= phases.data()[phase].begin && t < phases.data()[phase + 1].begin;
        return is_there ? within(phases.data()[phase], t) : look_up(t, phase);
    }

    double greatest_velocity() const;      ///< in either direction [u/s]
    double greatest_acceleration() const;  ///< in either direction [u/s^2]

  private:
    /// In any phase but the last.
    MotionState within(const Phase& now, double t) const {
        MotionState s = now.start.after(t - now.begin);
        s.position += missed * std::min(t * haste, 1.0);
        return s;
    }
    MotionState look_up(double t, std::size_t& phase) const;
};

/// From any state to the goal in the least time. not_finite: a number is NaN or infinite, what is
/// planned is beyond a double, or the numbers are so many decades apart that it would miss the
/// goal; velocity_above_limit: vf is outside of Vmin..V. On failure `out` is unchanged.
PlanResult plan(const MotionLimits& limits, const MotionState& from, const Goal& to,
                MotionPlan& out, const PlanOptions& options = {});

/// The same in the least feasible duration that is no less than `duration` [s].
PlanResult plan(const MotionLimits& limits, const MotionState& from, const Goal& to,
                double duration, MotionPlan& out, const PlanOptions& options = {});

}  // namespace lineshaft

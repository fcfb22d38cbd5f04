#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "blocks/profile/any_state.hpp"
#include "tests/blocks/profile/oracle.hpp"

/// The least duration from any state, found without the planner's equations: both fullest motions
/// are left at many moments by the direct ramp, and where the way crosses the goal for the first
/// time is found by halving. 64 bits of mantissa or more.
namespace lineshaft::reference {

using Real = long double;

struct Problem {
    double p0 = 0, v0 = 0, a0 = 0, pf = 0, vf = 0;
    double V = 1, Vmin = -1, A = 1, D = 1, J = 1;
};

struct State {
    Real x = 0, v = 0, a = 0;

    State after(Real t, Real j) const {
        return {x + t * (v + t * (a / 2 + t * j / 6)), v + t * (a + t * j / 2), a + t * j};
    }
};

struct Limit {
    Real V, A, D, J;
};

struct Piece {
    Real time, jerk;
};

/// The time-optimal change of velocity.
inline std::array<Piece, 3> ramp(const State& s, Real vf, const Limit& l) {
    const Real stop = s.v + s.a * std::abs(s.a) / (2 * l.J);
    const Real sign = vf >= stop ? 1 : -1;
    const Real A = sign > 0 ? l.A : l.D, a = sign * s.a, e = sign * (vf - stop);
    if (a > A) return {{{(a - A) / l.J, -sign * l.J}, {e / A, 0}, {A / l.J, -sign * l.J}}};
    Real peak = std::sqrt(l.J * e + (a > 0 ? a * a : 0));
    const Real hold = peak > A ? (peak - A) * (peak + A) / (l.J * A) : 0;
    peak = std::min(peak, A);
    const Real up = a > 0 && hold == 0 ? e / (peak + a) : (peak - a) / l.J;
    return {{{std::max(up, Real(0)), sign * l.J}, {hold, 0}, {peak / l.J, -sign * l.J}}};
}

struct Leaving {
    Real way, time;
};

/// Left at s, after `before` of the fullest motion.
inline Leaving leave(State s, Real before, Real vf, const Limit& l) {
    for (const Piece& p : ramp(s, vf, l)) {
        s = s.after(p.time, p.jerk);
        before += p.time;
    }
    return {s.x, before};
}

/// The first duration no less than `least` at which the side ahead reaches `way`; infinite if the
/// side does not. The state is one that the limits allow for.
inline Real first(const State& s0, Real way, Real vf, const Limit& l, Real least = 0) {
    std::array<Piece, 3> fullest = ramp(s0, l.V, l);
    if (s0.v + s0.a * std::abs(s0.a) / (2 * l.J) > l.V)
        fullest = {{{std::abs(s0.a) / l.J, s0.a > 0 ? -l.J : l.J}, {0, 0}, {0, 0}}};
    constexpr int samples = 24;
    State s = s0;
    Real before = 0;
    Leaving last = leave(s, 0, vf, l);
    bool below = last.time >= least && last.way < way;
    if (last.time >= least && last.way == way) return last.time;
    for (const Piece& piece : fullest) {
        if (!(piece.time > 0)) continue;
        const auto left_at = [&](Real t) {
            return leave(s.after(t, piece.jerk), before + t, vf, l);
        };
        const auto crossing = [&](Real low, Real high) {
            for (int i = 0; i < 90 && high - low > 1e-18L * high; ++i) {
                const Real middle = (low + high) / 2;
                const Leaving m = left_at(middle);
                (m.way < way || m.time < least ? low : high) = middle;
            }
            return left_at(high).time;
        };
        Real earlier = last.way;
        for (int i = 1; i <= samples; ++i) {
            const Real t = piece.time * i / samples, step = piece.time / samples;
            const Leaving now = left_at(t);
            if (now.time >= least) {
                if (below && now.way >= way) return crossing(t - step, t);
                if (below && last.way >= now.way && last.way >= earlier) {  // a top in between
                    Real low = std::max(t - 2 * step, Real(0)), high = t;
                    for (int k = 0; k < 60; ++k) {
                        const Real m1 = low + (high - low) * 0.4L, m2 = low + (high - low) * 0.6L;
                        if (left_at(m1).way < left_at(m2).way)
                            low = m1;
                        else
                            high = m2;
                    }
                    const Leaving top = left_at(low);
                    if (top.way >= way && top.time >= least)
                        return crossing(std::max(t - 2 * step, Real(0)), low);
                }
                below = below || now.way < way;
            }
            earlier = last.way;
            last = now;
        }
        s = s.after(piece.time, piece.jerk);
        before += piece.time;
    }
    s.v = l.V;
    s.a = 0;
    const Leaving cruising = leave(s, before, vf, l);
    const Real cruise = (way - cruising.way) / l.V;
    if (cruise < 0) return HUGE_VALL;
    return cruising.time + cruise >= least ? cruising.time + cruise : HUGE_VALL;
}

inline State mirrored(const State& s) {
    return {-s.x, -s.v, -s.a};
}

/// A state on its way back inside the limits.
struct Return {
    State state;
    Real time = 0;  ///< from when on it is planned to the goal [s]
    Real kept = 0;  ///< from when on all limits are kept, at the latest [s]

    void run(Real duration, Real jerk) {
        state = state.after(duration, jerk);
        time += duration;
    }
};

inline bool passes(const State& s, const Limit& l) {
    return s.v + s.a * std::abs(s.a) / (2 * l.J) > l.V;
}

/// Until V is joined tangentially.
inline void brake_gently(Return& back, const Limit& l, Real sign) {
    const std::array<Piece, 3> pieces = ramp(back.state, sign * l.V, {l.V, l.D, l.D, l.J});
    for (int i = 0; i < 2; ++i) back.run(pieces[i].time, pieces[i].jerk);
}

/// The hardest brake, found by halving: until V is kept, or the limit of the other side is so only
/// by turning back at once.
inline void brake_soon(Return& back, const Limit& l, Real other, Real sign) {
    const auto goes_on = [&](const State& s) {
        const Real v = sign * s.v, a = sign * s.a;
        return a >= 0 || (v > l.V && v - a * a / (2 * l.J) > -other);
    };
    const auto run = [&](Real longest, Real jerk) {
        if (!(longest > 0) || !goes_on(back.state)) return;
        Real low = 0, high = longest;
        if (goes_on(back.state.after(high, jerk))) low = high;
        for (int i = 0; i < 90 && low < high; ++i) {
            const Real middle = (low + high) / 2;
            (goes_on(back.state.after(middle, jerk)) ? low : high) = middle;
        }
        back.run(high, jerk);
    };
    run((sign * back.state.a + l.D) / l.J, -sign * l.J);
    run((sign * back.state.v - l.V) / l.D, 0);
}

/// How long v stays above V while it is turned back.
inline Real above(const State& s, const Limit& l) {
    if (!(s.v > l.V)) return 0;
    const Real square = s.a * s.a - 2 * l.J * (s.v - l.V);
    return 2 * (s.v - l.V) / (std::sqrt(std::max(square, Real(0))) - s.a);
}

/// The acceleration comes back first, then a velocity that goes on to pass its limit; by soonest
/// also one that has passed it and comes back by itself.
inline Return inside(const State& s0, const Limit& up, const Limit& down, Entry entry) {
    Return back{s0};
    const bool passes_up = passes(s0, up), passes_down = passes(mirrored(s0), down);
    if (s0.a < -up.D && !passes_down) {
        back.run((-up.D - s0.a) / up.J, up.J);
        back.state.a = -up.D;
    }
    if (s0.a > up.A && !passes_up) {
        back.run((s0.a - up.A) / up.J, -up.J);
        back.state.a = up.A;
    }
    const auto brake = [&](const Limit& l, Real other, Real sign) {
        if (entry == Entry::gentle)
            brake_gently(back, l, sign);
        else
            brake_soon(back, l, other, sign);
    };
    const bool soon = entry == Entry::soonest;
    if (passes_up || (soon && !passes_down && back.state.v > up.V))
        brake(up, down.V, 1);
    else if (passes_down || (soon && -back.state.v > down.V))
        brake(down, up.V, -1);
    back.kept = back.time + std::max(above(back.state, up), above(mirrored(back.state), down));
    return back;
}

inline Return inside(const Problem& p, Entry entry) {
    return inside({0, p.v0, p.a0}, {p.V, p.A, p.D, p.J}, {-Real(p.Vmin), p.D, p.A, p.J}, entry);
}

/// The least duration that is no less than `least` [s].
inline double duration(const Problem& p, double least = 0, Entry entry = Entry::gentle) {
    const Limit up{p.V, p.A, p.D, p.J}, down{-Real(p.Vmin), p.D, p.A, p.J};
    const Return back = inside(p, entry);
    const State& s = back.state;
    const Real way = Real(p.pf) - p.p0;
    const Real rest = std::max(Real(0), least - back.time);
    const Real ahead = first(s, way, p.vf, up, rest);
    const Real behind = first(mirrored(s), -way, -p.vf, down, rest);
    return static_cast<double>(back.time + std::min(ahead, behind));
}

}  // namespace lineshaft::reference

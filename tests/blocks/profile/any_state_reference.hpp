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

/// The brake that brings a state back inside, to the tangential point (gentle).
inline State inside(const State& s0, const Limit& up, const Limit& down, Real& time) {
    State s = s0;
    const auto over = [](const State& x, const Limit& l) {
        return x.v + x.a * std::abs(x.a) / (2 * l.J) > l.V;
    };
    const auto run = [&](std::array<Piece, 3> pieces) {
        for (int i = 0; i < 2; ++i) {
            s = s.after(pieces[i].time, pieces[i].jerk);
            time += pieces[i].time;
        }
    };
    if (s.a < -up.D && !over(mirrored(s), down)) {
        time += (-up.D - s.a) / up.J;
        s = s.after((-up.D - s.a) / up.J, up.J);
        s.a = -up.D;
    }
    if (s.a > up.A && !over(s, up)) {
        time += (s.a - up.A) / up.J;
        s = s.after((s.a - up.A) / up.J, -up.J);
        s.a = up.A;
    }
    if (over(s, up))
        run(ramp(s, up.V, up));
    else if (over(mirrored(s), down))
        run(ramp(s, -down.V, up));
    return s;
}

/// The least duration that is no less than `least` [s].
inline double duration(const Problem& p, double least = 0) {
    const Limit up{p.V, p.A, p.D, p.J}, down{-Real(p.Vmin), p.D, p.A, p.J};
    Real before = 0;
    const State s = inside({0, p.v0, p.a0}, up, down, before);
    const Real way = Real(p.pf) - p.p0;
    const Real rest = std::max(Real(0), least - before);
    const Real ahead = first(s, way, p.vf, up, rest);
    const Real back = first(mirrored(s), -way, -p.vf, down, rest);
    return static_cast<double>(before + std::min(ahead, back));
}

}  // namespace lineshaft::reference

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "blocks/profile/motion_limits.hpp"
#include "blocks/profile/peak_equations.hpp"
#include "blocks/profile/twice.hpp"

/// The fullest motion towards one side, left at some moment by the direct ramp to the goal's
/// velocity: any_state.hpp says how, and has the equations.
namespace lineshaft::peak_motion {

inline constexpr double ulp = std::numeric_limits<double>::epsilon();

/// The problem seen so that the way ahead is positive.
struct Frame {
    const MotionLimits::Side* side;
    double J, per_J;
    double sign;
    double v, a, vf, way;
    double e = 0;           ///< velocity missing once a is at zero at once
    double tau = 0;         ///< a/J
    double vb = 0, vt = 0;  ///< velocities of the virtual point, and at the jerk time tau
    double Dv = 0;          ///< vb - vf
    double ramp = 0;        ///< way of the direct ramp from the virtual point
    double miss = 0;        ///< from its end to the goal

    double vz() const { return a > 0 ? vt : vb; }  ///< with a at zero at once
};

static inline Frame frame(const MotionLimits& limits, double sign, const MotionState& s, double vf,
                          double way, double e) {
    const double v = sign * s.velocity, a = sign * s.acceleration, goal = sign * vf;
    const double tau = a * limits.per_J, gain = 0.5 * a * tau;
    const double missing = e == 0 ? std::copysign(gain, a) : goal - v;
    return {&limits.side[sign < 0],
            limits.J,
            limits.per_J,
            sign,
            v,
            a,
            goal,
            sign * way,
            sign * e,
            tau,
            v - gain,
            v + gain,
            -missing - gain};
}

/// Jerk +J for q - tau, hold, -J for q, cruise, -J for r, hold, +J for r.
struct Peak {
    double rise, up_hold, q, cruise, r, down_hold, turn;
    double v;                             ///< velocity at the peak, a virtual one in a dip
    double rise_rest = 0, turn_rest = 0;  ///< what the rise and the turn have lost by rounding
};

/// The way from the virtual point.
static inline double reach(const Frame& f, const Peak& p) {
    return (f.vb + p.v) * (p.q + 0.5 * p.up_hold) + (p.v + f.vf) * (p.r + 0.5 * p.down_hold) +
           p.v * p.cruise;
}

/// The way left to the goal.
static inline double left(const Frame& f, const Peak& p) {
    return f.miss - (reach(f, p) - f.ramp);
}

static inline double time(const Peak& p) {
    return p.rise + p.up_hold + p.turn + p.cruise + p.down_hold + p.r;
}

/// The direct ramp.
static inline Peak direct(const Frame& f) {
    if (f.e > 0 || (f.e == 0 && f.a < 0)) {
        const RampShape s = ramp_shape(f.a, f.e, f.side->A, f.J);
        return {s.to_peak, s.hold, s.to_zero, 0, 0, 0, s.to_zero, f.vf};
    }
    const RampShape s = ramp_shape(-f.a, -f.e, f.side->D, f.J);
    return {0, 0, f.tau, 0, s.to_zero, s.hold, s.to_peak, f.vt};
}

/// The same ramp in the mirrored frame.
static inline Peak mirrored(const Frame& f, const Peak& p) {
    if (p.r == 0) return {0, 0, f.tau, 0, p.q, p.up_hold, p.rise, f.vt};
    return {p.turn, p.down_hold, p.r, 0, 0, 0, p.r, f.vf};
}

struct Ramp {
    double jerk_time, hold;
};

/// Selects instead of branching.
static inline Ramp ramp(double dv, double per_J, double per_limit, double jerk_time,
                        double triangle) {
    const double root = std::sqrt(std::max(dv, 0.0) * per_J);
    const double hold = std::max(dv * per_limit - jerk_time, 0.0);
    const bool held = dv > triangle;
    return {held ? jerk_time : root, held ? hold : 0.0};
}

/// Both ramps over a peak velocity that a does not overshoot.
[[gnu::always_inline]] static inline Peak over(const Frame& f, double v) {
    const Ramp up = ramp(v - f.vb, f.per_J, f.side->per_A, f.side->alpha, f.side->rise);
    const Ramp down = ramp(v - f.vf, f.per_J, f.side->per_D, f.side->delta, f.side->fall);
    const double q = std::max(up.jerk_time, f.tau);
    return {q - f.tau, up.hold, q, 0, down.jerk_time, down.hold, q + down.jerk_time, v};
}

/// Which of a motion's ramps stay as they are but for their holds when it gets fuller.
struct Section {
    bool up_held = false, down_held = false;
    double high = HUGE_VAL;  ///< what is unknown is no more
};

// Motions become fuller in place: a copy of what has just been written makes the processor wait.

/// Both ramps triangular, the sum of their jerk times y longer.
static inline void lengthen(const Frame& f, Peak& p, double y) {
    if (!(y > 0)) return;
    const double m = p.turn + y, half = 0.5 * y / m;
    const double up = half * (2 * p.r + y);
    p.v += f.J * up * (2 * p.q + up);
    p.rise += up;
    p.r = std::max(p.r + half * (2 * p.q + y), 0.0);
    p.q += up;
    p.turn = m;
}

/// The way up triangular, its jerk time x longer, the way down held.
static inline void lengthen_up(const Frame& f, Peak& p, double x) {
    const double gain = f.J * x * (2 * p.q + x);
    p.down_hold = std::max(p.down_hold + gain * f.side->per_D, 0.0);
    p.v += gain;
    p.rise += x;
    p.q += x;
    p.turn += x;
}

/// The way down triangular, its jerk time x longer, the way up held.
static inline void lengthen_down(const Frame& f, Peak& p, double x) {
    const double gain = f.J * x * (2 * p.r + x);
    p.up_hold += gain * f.side->per_A;
    p.v += gain;
    p.r += x;
    p.turn += x;
}

/// Both ramps held, the peak faster by gain.
static inline void quicken(const Frame& f, Peak& p, double gain) {
    p.up_hold += gain * f.side->per_A;
    p.down_hold += gain * f.side->per_D;
    p.v += gain;
}

/// The q < 0 at which the hold of a dip ends, or 0.
static inline double end_of_hold(const Frame& f) {
    const double square = f.side->delta * f.side->delta - f.Dv * f.per_J;
    return square > 0 ? -std::sqrt(square) : 0;
}

/// The motion whose peak is where the way up begins to hold, or the way down.
static inline Peak border_of(const Frame& f, double v, bool up) {
    Peak p = over(f, v);
    p.q = up ? f.side->alpha : p.q;
    p.rise = up ? p.q - f.tau : p.rise;
    p.up_hold = up ? 0 : p.up_hold;
    p.r = up ? p.r : f.side->delta;
    p.down_hold = up ? p.down_hold : 0;
    p.turn = p.q + p.r;
    return p;
}

/// From a motion below V on over the shapes' borders that `beyond` tells to lie before the goal:
/// the last of them becomes the motion.
template <class Beyond>
static inline Section section(const Frame& f, Peak& p, const Beyond& beyond) {
    double start = std::max(std::max(f.vf, f.vz()), p.q > 0 ? p.v : f.vf);
    if (p.q < 0 && p.down_hold > 0) {
        const double q = end_of_hold(f);
        if (q < 0 && q > p.q) {
            Peak border = p;
            lengthen_up(f, border, q - p.q);
            if (!beyond(border)) return {false, true};
            border.down_hold = 0;
            p = border;
        }
    }
    const double holds_up = f.vb + f.side->rise, holds_down = f.vf + f.side->fall;
    const bool up_first = holds_up < holds_down;
    const double first = std::min(holds_up, holds_down), second = std::max(holds_up, holds_down);
    if (first > start) {
        if (!(first < f.side->V)) return {};
        const Peak border = border_of(f, first, up_first);
        if (!beyond(border)) return {};
        p = border;
    }
    if (second > start) {
        if (!(second < f.side->V)) return {up_first, !up_first};
        const Peak border = border_of(f, second, !up_first);
        if (!beyond(border)) return {up_first, !up_first};
        p = border;
    }
    return {true, true};
}

/// The motion of the section goes `miss` farther.
static inline void go_farther(const Frame& f, Peak& p, const Section& s, double miss) {
    const MotionLimits::Side& side = *f.side;
    const auto high = [&](double x) { return std::min(std::max(x, 0.0), s.high); };
    if (!(miss > 0)) return;
    if (s.up_held && s.down_held) {
        const double curvature = side.per_A + side.per_D;
        const double slope = p.v * curvature + 0.5 * (side.alpha + side.delta);
        const double root = std::sqrt(slope * slope + 2 * curvature * miss);
        quicken(f, p, slope > 0 ? 2 * miss / (slope + root) : (root - slope) / curvature);
    } else if (s.down_held) {
        const PeakStart start{f.J, p.v, p.q, p.r, p.turn};
        lengthen_up(f, p, mixed_step(start, side.delta, miss, high(side.alpha - p.q)));
    } else if (s.up_held) {
        const PeakStart start{f.J, p.v, p.r, p.q, p.turn};
        lengthen_down(f, p, mixed_step(start, side.alpha, miss, high(side.delta - p.r)));
    } else {
        const PeakStart start{f.J, p.v, p.q, p.r, p.turn};
        lengthen(f, p, triangular_step(start, miss, high(side.alpha + side.delta - p.turn)));
    }
}

/// The motion of the section lasts `time` longer.
static inline void last_longer(const Frame& f, Peak& p, const Section& s, double time) {
    const MotionLimits::Side& side = *f.side;
    const auto step = [&](double q, double t) {
        const double u = 1 + q / t;
        return time / (u + std::sqrt(u * u + time / t));
    };
    if (!(time > 0)) return;
    if (s.up_held && s.down_held)
        quicken(f, p, time / (side.per_A + side.per_D));
    else if (s.down_held)
        lengthen_up(f, p, step(p.q, side.delta));
    else if (s.up_held)
        lengthen_down(f, p, step(p.r, side.alpha));
    else
        lengthen(f, p, 0.5 * time);
}

/// How much longer q, or q + r, is where the way in a dip is greatest.
static inline double top_of_dip(const Frame& f, const Peak& from, bool down_held) {
    if (down_held) {
        const double square = f.side->D * f.side->D - 16 * f.J * f.vb;
        return square > 0 ? -0.25 * (f.side->D + std::sqrt(square)) * f.per_J - from.q : 0;
    }
    const double S = f.vb + f.vf, square = 4 * S * S - 3 * f.Dv * f.Dv;
    if (!(S < 0 && square > 0)) return 0;
    return std::sqrt((-2 * S - std::sqrt(square)) * (1.0 / 3) * f.per_J) - from.turn;
}

/// For vf < 0 the way has a greatest value in a dip at most: where the goal is hit before, the
/// motion becomes that one.
[[gnu::noinline]] static bool solve_in_dip(const Frame& f, Peak& from) {
    Peak p = from, highest = from;
    Section s{false, p.down_hold > 0};
    const auto hits = [&](const Peak& top) { return s.high > 0 && left(f, top) <= 0; };
    if (s.down_held) {
        const double last = end_of_hold(f), end = last - p.q, top = top_of_dip(f, p, true);
        s.high = top > 0 && top < end ? top : end;
        lengthen_up(f, highest, s.high);
        const bool is_hit = hits(highest);
        if (!is_hit && last == 0) return false;
        if (is_hit) {
            go_farther(f, from, s, left(f, from));
            return true;
        }
        lengthen_up(f, p, std::max(end, 0.0));
        p.down_hold = 0;
        s.down_held = false;
        highest = p;
    }
    s.high = top_of_dip(f, p, false);
    lengthen(f, highest, s.high);
    if (!(highest.q < 0 && hits(highest))) return false;
    go_farther(f, p, s, left(f, p));
    from = p;
    return true;
}

/// The motion becomes the first after it that ends at the goal.
static inline void solve(const Frame& f, Peak& p) {
    if (f.vf < 0 && p.q < 0 && solve_in_dip(f, p)) return;
    const double vz = f.vz();
    const Peak fullest = over(f, std::max(f.side->V, vz));
    const double rest = left(f, fullest);
    if (rest < 0 && (p.q < 0 || std::max(f.vf, vz) < f.side->V)) {
        const Section s = section(f, p, [&](const Peak& border) { return left(f, border) > 0; });
        go_farther(f, p, s, left(f, p));
    } else {
        p = fullest;
        p.cruise = std::max(rest, 0.0) / fullest.v;
    }
}

/// The motion becomes the one to the greatest position that is reached in a time.
static inline void solve_timed(const Frame& f, Peak& p, double duration) {
    const double vz = f.vz();
    const Peak fullest = over(f, std::max(f.side->V, vz));
    const double rest = duration - time(fullest);
    if (rest < 0 && (p.q < 0 || std::max(f.vf, vz) < f.side->V)) {
        const Section s =
            section(f, p, [&](const Peak& border) { return time(border) < duration; });
        last_longer(f, p, s, duration - time(p));
    } else {
        p = fullest;
        p.cruise = std::max(rest, 0.0);
    }
}

/// The way down makes up for what the time up and the turn have lost.
static inline void fit_turn(Peak& p, double up, double rest, double grain) {
    const double r = p.turn - up;
    const double left_over = (r - p.r) + (sum_error(p.turn, -up, r) - rest);
    if (std::abs(left_over) * p.down_hold > grain)
        p.turn_rest = -left_over;
    else
        p.r += left_over;
}

/// What rounding takes from one jerk time the later ones make up for. Where acceleration left over
/// would matter in a hold or a cruise, a phase as short as the rounding frees it of that before.
static inline void fit(const Frame& f, double a_rest, Peak& p) {
    if (!(p.up_hold > 0 || p.down_hold > 0 || p.cruise > 0)) return;
    const double grain =
        ulp * f.per_J * std::max(std::max(std::abs(f.v), std::abs(f.vf)), std::abs(p.v));
    const auto matters = [&](double rest, double time) { return std::abs(rest) * time > grain; };
    const double product = f.J * f.tau;
    double sum = p.rise + f.tau;
    double rest =
        sum_error(p.rise, f.tau, sum) +
        ((f.a - product) - product_error(f.J, f.tau, product) + f.sign * a_rest) * f.per_J;
    if (const double missing = (p.q - sum) - rest; matters(missing, p.up_hold)) {
        p.rise_rest = missing;
        sum = p.q;
        rest = 0;
    }
    if (p.cruise > 0) {
        p.q = std::max(sum + rest, 0.0);
        const double left_over = (sum - p.q) + rest;
        p.turn_rest = matters(left_over, p.cruise) ? left_over : 0;
        return;
    }
    fit_turn(p, sum, rest, grain);
}

/// The cruise makes up for what rounding does to the ramps.
static inline void fit_cruise(const Frame& f, Peak& p) {
    MotionState s{0, f.v, f.a, f.J};
    s = s.after(p.rise);
    s = MotionState{s.position, s.velocity, f.J * p.q, 0}.after(p.up_hold);
    s = MotionState{s.position, s.velocity, f.J * p.q, -f.J}.after(p.q);
    const double down = (p.v + f.vf) * (p.r + 0.5 * p.down_hold);
    p.cruise = std::max(f.way - s.position - down, 0.0) / p.v;
}

/// Motion: Steps or a Track.
template <class Motion>
[[gnu::always_inline]] static inline void add(const Frame& f, const Peak& p, Motion& motion) {
    const double J = f.sign * f.J, up = J * p.q, down = -J * p.r;
    const auto add_rest = [&](double rest, double jerk, double acceleration) {
        if (rest != 0) motion.add(std::abs(rest), std::copysign(jerk, rest * jerk), acceleration);
    };
    motion.add(p.rise, J, up);
    if (p.up_hold > 0 || p.down_hold > 0 || p.cruise > 0) {
        add_rest(p.rise_rest, J, up);
        motion.add(p.up_hold, 0, up);
        if (p.cruise > 0) {
            motion.add(p.q, -J, 0);
            add_rest(p.turn_rest, -J, 0);
            motion.add(p.cruise, 0, 0);
            motion.add(p.r, -J, down);
        } else {
            motion.add(p.turn, -J, down);
            add_rest(p.turn_rest, -J, down);
        }
        motion.add(p.down_hold, 0, down);
    } else {
        motion.add(p.turn, -J, down);
    }
    motion.add(p.r, J, 0);
}

}  // namespace lineshaft::peak_motion

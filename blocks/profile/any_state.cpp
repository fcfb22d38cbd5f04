#include "blocks/profile/any_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks/profile/peak_equations.hpp"

namespace lineshaft {
namespace {

constexpr double ulp = std::numeric_limits<double>::epsilon();

/// What rounding took from a sum, exactly (Knuth).
double sum_error(double a, double b, double sum) {
    const double bb = sum - a;
    return (a - (sum - bb)) + (b - bb);
}

/// A motion as its jerks, with the acceleration at the end of each.
struct Steps {
    struct Step {
        double duration, jerk, acceleration;
    };
    std::array<Step, MotionPlan::most_phases + 1> list;
    std::size_t count = 0;
    double duration = 0;

    void add(double time, double jerk, double acceleration) {
        list[count] = {time, jerk, acceleration};
        count += time > 0 ? 1 : 0;
        duration += time;
    }
};

/// The problem seen so that the way ahead is positive.
struct Frame {
    const MotionLimits::Side* side;
    double J, per_J;
    double sign;
    double v, a, vf, way;
    double e;            ///< velocity missing once a is at zero at once
    double tau, vb, vz;  ///< a/J; velocities of the virtual point, and with a at zero at once
    double S, Dv;        ///< vb + vf, vb - vf
    double L;            ///< way from the virtual point to the goal
};

Frame frame(const MotionLimits& limits, double sign, const MotionState& s, double vf, double way,
            double e) {
    const double v = sign * s.velocity, a = sign * s.acceleration, goal = sign * vf;
    const double tau = a * limits.per_J, gain = 0.5 * a * tau;
    const double vb = v - gain;
    const double missing = e == 0 ? std::copysign(gain, a) : goal - v;
    const double L = sign * way + tau * (v - a * tau * (1.0 / 3));
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
            vb,
            a > 0 ? v + gain : vb,
            vb + goal,
            -missing - gain,
            L};
}

/// Jerk +J for q - tau, hold, -J for q, cruise, -J for r, hold, +J for r.
struct Peak {
    double rise, up_hold, q, cruise, r, down_hold, turn;
};

Peak peak(const Frame& f, double q, double up_hold, double r, double down_hold) {
    return {std::max(q - f.tau, 0.0), up_hold, q, 0, r, down_hold, q + r};
}

double velocity(const Frame& f, const Peak& p) {
    return f.vb + f.J * p.q * (p.q + p.up_hold);
}

/// The way from the virtual point.
double reach(const Frame& f, const Peak& p) {
    const double vp = velocity(f, p);
    return (f.vb + vp) * (p.q + 0.5 * p.up_hold) + (vp + f.vf) * (p.r + 0.5 * p.down_hold) +
           vp * p.cruise;
}

/// The time from the virtual point.
double time(const Peak& p) {
    return p.q + p.up_hold + p.turn + p.cruise + p.down_hold + p.r;
}

/// The direct ramp.
Peak direct(const Frame& f) {
    if (f.e > 0 || (f.e == 0 && f.a < 0)) {
        const RampShape s = ramp_shape(f.a, f.e, f.side->A, f.J);
        return {s.to_peak, s.hold, s.to_zero, 0, 0, 0, s.to_zero};
    }
    const RampShape s = ramp_shape(-f.a, -f.e, f.side->D, f.J);
    return {0, 0, f.tau, 0, s.to_zero, s.hold, s.to_peak};
}

/// The same ramp in the mirrored frame.
Peak mirrored(const Frame& f, const Peak& p) {
    if (p.r == 0) return {0, 0, f.tau, 0, p.q, p.up_hold, p.rise};
    return {p.turn, p.down_hold, p.r, 0, 0, 0, p.r};
}

struct Ramp {
    double jerk_time, hold;
};

/// Selects instead of branching.
Ramp ramp(double dv, double per_J, double per_limit, double jerk_time, double triangle) {
    const double root = std::sqrt(dv > 0 ? dv * per_J : 0), hold = dv * per_limit - jerk_time;
    const bool held = dv > triangle;
    return {held ? jerk_time : root, held && hold > 0 ? hold : 0};
}

/// Both ramps over a peak velocity that a does not overshoot.
Peak over(const Frame& f, double vp) {
    const Ramp up = ramp(vp - f.vb, f.per_J, f.side->per_A, f.side->alpha, f.side->rise);
    const Ramp down = ramp(vp - f.vf, f.per_J, f.side->per_D, f.side->delta, f.side->fall);
    return peak(f, std::max(up.jerk_time, f.tau), up.hold, down.jerk_time, down.hold);
}

Peak triangular(const Frame& f, double m) {
    const double difference = f.Dv / (f.J * m);
    const double q = 0.5 * (m - difference);
    return peak(f, f.a > 0 ? std::max(q, f.tau) : q, 0, std::max(0.5 * (m + difference), 0.0), 0);
}

Peak up_triangular(const Frame& f, double q) {
    const double fall = f.Dv + f.J * q * q;
    return peak(f, q, 0, f.side->delta, std::max(fall * f.side->per_D - f.side->delta, 0.0));
}

Peak down_triangular(const Frame& f, double r) {
    const double rise = f.J * r * r - f.Dv;
    return peak(f, f.side->alpha, std::max(rise * f.side->per_A - f.side->alpha, 0.0), r, 0);
}

Peak trapezoidal(const Frame& f, double vp) {
    return peak(f, f.side->alpha, std::max((vp - f.vb) * f.side->per_A - f.side->alpha, 0.0),
                f.side->delta, std::max((vp - f.vf) * f.side->per_D - f.side->delta, 0.0));
}

double rest_beside_down(const Frame& f) {
    return f.L - 0.5 * f.S * (f.side->delta + f.Dv * f.side->per_D);
}
double rest_beside_up(const Frame& f) {
    return f.L - 0.5 * f.S * (f.side->alpha - f.Dv * f.side->per_A);
}

Peak solve_triangular(const Frame& f, const Peak& from) {
    const double low = std::max(from.q + from.r, std::sqrt(std::abs(f.Dv) * f.per_J));
    return triangular(
        f, triangular_sum(f.J, f.S, f.Dv, f.L, low, std::max(low, f.side->alpha + f.side->delta)));
}

Peak solve_up_triangular(const Frame& f, const Peak& from) {
    const double low = std::max(from.q, 0.0);
    return up_triangular(f, mixed_time(f.J, f.vb, f.side->delta, f.side->fall, rest_beside_down(f),
                                       low, std::max(low, f.side->alpha)));
}

Peak solve_down_triangular(const Frame& f, const Peak& from) {
    const double low = from.q < 0 ? std::sqrt(std::max(f.Dv, 0.0) * f.per_J) : from.r;
    return down_triangular(f, mixed_time(f.J, f.vf, f.side->alpha, f.side->rise, rest_beside_up(f),
                                         low, std::max(low, f.side->delta)));
}

/// From the velocity `low` on, where the way is still too short, it is quadratic in what is added.
Peak solve_trapezoidal(const Frame& f, double low) {
    const double missing = std::max(f.L - reach(f, trapezoidal(f, low)), 0.0);
    const double slope =
        low * (f.side->per_A + f.side->per_D) + 0.5 * (f.side->alpha + f.side->delta);
    const double curvature = f.side->per_A + f.side->per_D;
    const double root = std::sqrt(slope * slope + 2 * curvature * missing);
    return trapezoidal(
        f, low + (slope > 0 ? 2 * missing / (slope + root) : (root - slope) / curvature));
}

/// The peak lies below V.
Peak solve_below(const Frame& f, const Peak& from) {
    const double holds_up = f.vb + f.side->rise, holds_down = f.vf + f.side->fall;
    const double start = std::max({f.vf, f.vz, from.q > 0 ? velocity(f, from) : f.vz});
    const double first = std::min(holds_up, holds_down), both = std::max(holds_up, holds_down);
    const auto passes = [&](double vp) {
        return vp <= start || (vp < f.side->V && f.L > reach(f, over(f, vp)));
    };
    if (!passes(first)) return solve_triangular(f, from);
    if (passes(both)) return solve_trapezoidal(f, std::max(both, start));
    return holds_up < holds_down ? solve_down_triangular(f, from) : solve_up_triangular(f, from);
}

/// Where the way rises from `low` to its greatest before `high`, or falls, to its end; the first
/// crossing of L in there.
template <class Make>
bool cross(const Frame& f, const Quartic& equation, double low, double top, double high,
           const Make& make, Peak& found) {
    const auto enough = [&](double x) { return f.L <= reach(f, make(x)); };
    const bool inside = low < top && top < high;
    if (inside && enough(top))
        high = top;
    else if (!enough(high))
        return false;
    else if (inside)
        low = top;
    found =
        make(rising_root(equation, 0.5 * (low + high), 4 * ulp * std::max(-low, high), low, high));
    return true;
}

/// In the dip the motion turns down before the acceleration has come to zero: q < 0.
bool solve_dip(const Frame& f, const Peak& from, Peak& found) {
    double low = std::max(f.tau, from.q);
    const double square = f.side->delta * f.side->delta - f.Dv * f.per_J;
    const double border = square > 0 ? -std::sqrt(square) : 0;
    if (low < border) {
        const double root = f.side->D * f.side->D - 16 * f.J * f.vb;
        const double top = root > 0 ? -0.25 * (f.side->D + std::sqrt(root)) * f.per_J : border;
        if (cross(
                f, mixed_equation(f.J, f.vb, f.side->delta, f.side->fall, rest_beside_down(f)), low,
                top, border, [&](double q) { return up_triangular(f, q); }, found))
            return true;
        low = border;
    }
    if (!(low < 0) || square <= 0) return false;
    const double Dv_per_J = f.Dv * f.per_J;
    const double first = low + std::sqrt(low * low + Dv_per_J), last = std::sqrt(Dv_per_J);
    const double root = 4 * f.S * f.S - 3 * f.Dv * f.Dv;
    const double square_top = f.S < 0 && root > 0 ? (-2 * f.S - std::sqrt(root)) * (1.0 / 3) : 0;
    return cross(
        f, {0.25 * f.J, 0, f.S, -f.L, -0.25 * f.Dv * Dv_per_J}, first,
        std::sqrt(square_top * f.per_J), last, [&](double m) { return triangular(f, m); }, found);
}

/// The first motion after `from` that ends at the goal.
Peak solve(const Frame& f, const Peak& from) {
    Peak p;
    if (f.a < 0 && f.Dv > 0 && from.q < 0 && solve_dip(f, from, p)) return p;
    p = over(f, f.side->V);
    const double left = f.L - reach(f, p);
    if (left < 0 && std::max(f.vf, f.vz) < f.side->V) return solve_below(f, from);
    p.cruise = std::max(left, 0.0) / f.side->V;
    return p;
}

/// The motion to the greatest position that is reached at time u from the virtual point.
Peak timed(const Frame& f, double u) {
    Peak p = triangular(f, 0.5 * u);
    const double holds_up = f.vb + f.side->rise, holds_down = f.vf + f.side->fall;
    if (p.q > f.side->alpha || p.r > f.side->delta) {
        const auto square = [](double c, double t) {
            return c / (1 + std::sqrt(std::max(1 + c / t, 0.0)));
        };
        const bool down_first = p.q < 0 || holds_down <= holds_up;
        p = down_first
                ? up_triangular(f, square(u - f.side->delta - f.Dv * f.side->per_D, f.side->delta))
                : down_triangular(f,
                                  square(u - f.side->alpha + f.Dv * f.side->per_A, f.side->alpha));
        if (down_first ? p.q > f.side->alpha : p.r > f.side->delta)
            p = trapezoidal(f, (u - f.side->alpha - f.side->delta + f.vb * f.side->per_A +
                                f.vf * f.side->per_D) /
                                   (f.side->per_A + f.side->per_D));
    }
    if (p.q < 0 || velocity(f, p) <= f.side->V) return p;
    p = over(f, f.side->V);
    p.cruise = std::max(u - time(p), 0.0);
    return p;
}

/// What rounding takes from one jerk time the later ones make up for, so that little acceleration
/// is left over in a hold, in a cruise and at the end; and a hold lasts by what it is.
void fit(const Frame& f, double a_rest, Peak& p) {
    if (!(p.up_hold > 0 || p.down_hold > 0 || p.cruise > 0)) return;
    const double product = f.J * f.tau;
    const double tau_rest =
        ((f.a - product) - product_error(f.J, f.tau, product) + f.sign * a_rest) * f.per_J;
    const double sum = p.rise + f.tau;
    const double rest = sum_error(p.rise, f.tau, sum) + tau_rest;
    const double q = sum + rest;
    if (p.up_hold > 0) p.up_hold *= p.q / q;
    if (p.cruise > 0) {
        p.q = q;
    } else {
        const double r = p.turn - sum;
        const double fitted = r + (sum_error(p.turn, -sum, r) - rest);
        if (p.down_hold > 0) p.down_hold *= p.r / fitted;
        p.r = fitted;
    }
}

void add(const Frame& f, const Peak& p, Steps& steps) {
    const double J = f.sign * f.J, up = J * p.q, down = -J * p.r;
    steps.add(p.rise, J, up);
    steps.add(p.up_hold, 0, up);
    if (p.cruise > 0) {
        steps.add(p.q, -J, 0);
        steps.add(p.cruise, 0, 0);
        steps.add(p.r, -J, down);
    } else {
        steps.add(p.turn, -J, down);
    }
    steps.add(p.down_hold, 0, down);
    steps.add(p.r, J, 0);
}

/// The cruise makes up for what rounding does to the ramps.
void fit_cruise(const Frame& f, Peak& p) {
    if (!(p.cruise > 0)) return;
    MotionState s{0, f.v, f.a, f.J};
    s = s.after(p.rise);
    s = MotionState{s.position, s.velocity, f.J * p.q, 0}.after(p.up_hold);
    s = MotionState{s.position, s.velocity, f.J * p.q, -f.J}.after(p.q);
    const double down = (f.side->V + f.vf) * (p.r + 0.5 * p.down_hold);
    p.cruise = std::max(f.way - s.position - down, 0.0) / f.side->V;
}

/// Along `sign`: the velocity above the limit once a is at zero.
double excess(const MotionLimits& limits, const MotionState& s, double sign) {
    const double v = sign * s.velocity, a = sign * s.acceleration;
    return (v - limits.side[sign < 0].V) + 0.5 * a * std::abs(a) * limits.per_J;
}

/// A state under way back inside its limits, its position counted from the first one's.
struct Return {
    const MotionLimits& limits;
    Steps& steps;
    MotionState s;
    double a_rest = 0;  ///< what rounding has left of the acceleration beside that of the state

    void run(double time, double jerk, double acceleration) {
        if (!(time > 0)) return;
        steps.add(time, jerk, acceleration);
        const double change = acceleration - s.acceleration, product = jerk * time;
        a_rest += (product - change) + (product_error(jerk, time, product) -
                                        sum_error(acceleration, -s.acceleration, change));
        s.jerk = jerk;
        s = s.after(time);
        s.acceleration = acceleration;
    }

    /// Until V is joined tangentially: the velocity ramp to it without its last jerk.
    void gently(double sign, double over) {
        const RampShape ramp =
            ramp_shape(-sign * s.acceleration, over, limits.side[sign < 0].D, limits.J);
        run(ramp.to_peak, -sign * limits.J, -sign * ramp.peak);
        run(ramp.hold, 0, -sign * ramp.peak);
    }

    /// Until V is kept, or the limit of the other side could not be any more.
    void soon(double sign) {
        const MotionLimits::Side& side = limits.side[sign < 0];
        const double back = limits.side[sign > 0].V, J = limits.J;
        const double v = sign * s.velocity, a = sign * s.acceleration;
        const double keeps = std::sqrt(std::max(a * a + 2 * J * (v - side.V), 0.0));
        const double turns = std::sqrt(std::max(0.5 * a * a + J * (v + back), 0.0));
        const double peak = std::min({keeps, turns, side.D});
        run((a + peak) * limits.per_J, -sign * J, -sign * peak);
        if (peak < side.D) return;
        const double now = sign * s.velocity;
        run(std::min(now - side.V, now + back - 0.5 * side.fall) * side.per_D, 0, -sign * peak);
    }
};

bool is_inside(const MotionLimits& limits, const MotionState& s) {
    const MotionLimits::Side &up = limits.side[0], &down = limits.side[1];
    const double v = s.velocity, a = s.acceleration;
    const double turned = v + 0.5 * a * std::abs(a) * limits.per_J;
    return a <= up.A && -a <= down.A && std::max(v, turned) <= up.V &&
           -std::min(v, turned) <= down.V;
}

/// The state from which the motion is planned, after the steps that bring it inside the limits.
MotionState enter(const MotionLimits& limits, const MotionState& from, const PlanOptions& options,
                  Steps& steps, double& a_rest) {
    if (is_inside(limits, from)) return {0, from.velocity, from.acceleration, 0};
    const double slack = options.tolerance * ulp;
    Return back{limits, steps, {0, from.velocity, from.acceleration, 0}, 0};
    for (const double sign : {1.0, -1.0}) {
        const MotionLimits::Side& side = limits.side[sign < 0];
        const double room = slack * std::max(side.V, std::abs(from.velocity));
        if (sign * back.s.acceleration > side.A * (1 + slack) &&
            excess(limits, back.s, sign) <= room)
            back.run((sign * back.s.acceleration - side.A) * limits.per_J, -sign * limits.J,
                     sign * side.A);
    }
    for (const double sign : {1.0, -1.0}) {
        const double V = limits.side[sign < 0].V;
        const double room = slack * std::max(V, std::abs(from.velocity));
        const double over = excess(limits, back.s, sign);
        if (options.entry == Entry::soonest && (over > room || sign * back.s.velocity > V + room))
            back.soon(sign);
        else if (over > room)
            back.gently(sign, over);
        else
            continue;
        break;
    }
    a_rest = back.a_rest;
    return back.s;
}

/// The mean of two motions of equal duration, one of weight lambda.
void blend(const Steps& one, const Steps& other, double lambda, double a, Steps& out) {
    const auto mean = [&](double x, double y) { return lambda * x + (1 - lambda) * y; };
    std::size_t i = 0, k = 0;
    double left_i = one.list[0].duration, left_k = other.list[0].duration;
    double a_i = a, a_k = a;
    while (i < one.count && k < other.count) {
        const Steps::Step &x = one.list[i], &y = other.list[k];
        const double time = std::min(left_i, left_k);
        const bool ends_i = left_i <= time, ends_k = left_k <= time;
        a_i = ends_i ? x.acceleration : a_i + x.jerk * time;
        a_k = ends_k ? y.acceleration : a_k + y.jerk * time;
        out.add(time, mean(x.jerk, y.jerk), mean(a_i, a_k));
        left_i = ends_i ? one.list[++i].duration : left_i - time;
        left_k = ends_k ? other.list[++k].duration : left_k - time;
    }
}

PlanResult check(const MotionLimits& limits, const MotionState& from, const Goal& to) {
    const double way = to.position - from.position;
    if (!std::isfinite(way + from.velocity + from.acceleration + to.velocity))
        return PlanResult::not_finite;
    return to.velocity <= limits.side[0].V && -to.velocity <= limits.side[1].V
               ? PlanResult::ok
               : PlanResult::velocity_above_limit;
}

/// Runs the steps; what they miss is the drift.
PlanResult write(const Steps& steps, const MotionLimits& limits, const MotionState& from,
                 const Goal& to, MotionPlan& out) {
    const double gain = from.acceleration * from.acceleration * limits.per_J;
    const double greatest =
        std::abs(from.velocity) + gain + std::max(limits.side[0].V, limits.side[1].V);
    if (!std::isfinite(std::abs(from.position) + greatest * steps.duration))
        return PlanResult::not_finite;
    double x = 0, v = from.velocity, a = from.acceleration, begin = 0;
    for (std::size_t i = 0; i < steps.count; ++i) {
        const Steps::Step& step = steps.list[i];
        out.phases[i] = {begin, step.duration, {from.position + x, v, a, step.jerk}};
        const MotionState end = MotionState{x, v, a, step.jerk}.after(step.duration);
        x = end.position;
        v = end.velocity;
        a = step.acceleration;
        begin += step.duration;
    }
    out.count = steps.count;
    out.duration = begin;
    out.end = {to.position, to.velocity, 0, 0};
    const double drift = ((to.position - from.position) - x) / begin;
    out.drift = std::isfinite(drift) ? drift : 0;
    return PlanResult::ok;
}

void add_fitted(const Frame& f, Peak& p, double a_rest, Steps& steps) {
    fit(f, a_rest, p);
    add(f, p, steps);
}

/// The problem from where the state is inside the limits, with its direct ramp.
struct Start {
    Steps steps;
    double a_rest = 0;
    MotionState state;
    double vf, way;
    Frame ahead;
    Peak ramp;
    double tolerance;  ///< [u]

    /// The velocity missing once a is at zero, or 0 where that is within the tolerance at the goal:
    /// the square root of a rounding would be far more than a rounding of the duration.
    double missing(const MotionLimits& limits, const MotionState& from, const Goal& to,
                   double slack) const {
        const double e =
            missing_velocity(state.velocity, state.acceleration, vf, 0.5 * limits.per_J);
        const double tau = std::abs(state.acceleration) * limits.per_J;
        const double v = std::max(std::abs(state.velocity), std::abs(vf));
        if (std::abs(e) > slack * std::max(v, std::abs(state.acceleration) * tau)) return e;
        const double x = tau * (state.velocity + state.acceleration * tau * (1.0 / 3));
        const double size = std::max({std::abs(from.position), std::abs(to.position), v * tau});
        return std::abs(way - x) <= slack * size ? 0 : e;
    }

    Start(const MotionLimits& limits, const MotionState& from, const Goal& to,
          const PlanOptions& options)
        : state(enter(limits, from, options, steps, a_rest)),
          vf(to.velocity),
          way((to.position - from.position) - state.position),
          ahead(
              frame(limits, 1, state, vf, way, missing(limits, from, to, options.tolerance * ulp))),
          ramp(direct(ahead)) {
        const double path = duration() * std::max(std::abs(state.velocity), std::abs(vf));
        tolerance = options.tolerance * ulp *
                    std::max({std::abs(from.position), std::abs(to.position), path});
    }

    double duration() const { return time(ramp) - ahead.tau; }
    Frame back(const MotionLimits& limits) const {
        return frame(limits, -1, state, vf, way, ahead.e);
    }
};

/// The first motion of the frame's side after `from` that ends at the goal.
void add_solved(const Frame& f, const Peak& from, Start& start) {
    Peak p = solve(f, from);
    fit_cruise(f, p);
    add_fitted(f, p, start.a_rest, start.steps);
}

void add_soonest(const MotionLimits& limits, Start& start) {
    const double missing = start.ahead.L - reach(start.ahead, start.ramp);
    if (std::abs(missing) <= start.tolerance) {
        add_fitted(start.ahead, start.ramp, start.a_rest, start.steps);
    } else if (missing > 0) {
        add_solved(start.ahead, start.ramp, start);
    } else {
        const Frame back = start.back(limits);
        add_solved(back, mirrored(back, start.ramp), start);
    }
}

/// The motions to the greatest and the least position in a time are closed forms, and any mean of
/// them keeps the limits. Beyond them the next crossing of the side that is short is feasible.
/// False if the motion takes longer.
bool add_timed(const MotionLimits& limits, Start& start, double duration) {
    if (duration <= start.duration()) {
        add_soonest(limits, start);
        return duration == start.duration();
    }
    const Frame back = start.back(limits);
    Peak up = timed(start.ahead, duration + start.ahead.tau);
    Peak down = timed(back, duration + back.tau);
    const double above = start.ahead.L - reach(start.ahead, up);
    const double below = back.L - reach(back, down);
    if (above > start.tolerance || below > start.tolerance) {
        if (above > start.tolerance)
            add_solved(start.ahead, up, start);
        else
            add_solved(back, down, start);
        return false;
    }
    Steps upper, lower;
    add_fitted(start.ahead, up, start.a_rest, upper);
    add_fitted(back, down, start.a_rest, lower);
    const double room = -above - below;
    const double lambda = room > 0 ? std::min(std::max(-below / room, 0.0), 1.0) : 1;
    blend(upper, lower, lambda, start.state.acceleration, start.steps);
    return true;
}

}  // namespace

PlanResult MotionLimits::set(double V, double Vmin, double A, double D, double jerk) {
    const auto good = [](double x) { return x > 0 && x <= std::numeric_limits<double>::max(); };
    if (!good(V) || !good(-Vmin) || !good(A) || !good(D) || !good(jerk))
        return PlanResult::limit_not_positive;
    const Side up{V, A, D, A / jerk, D / jerk, A * (A / jerk), D * (D / jerk), 1 / A, 1 / D};
    if (!good(up.rise) || !good(up.fall) || !good(up.per_A) || !good(up.per_D) || !good(1 / jerk))
        return PlanResult::not_finite;
    side = {up, {-Vmin, D, A, up.delta, up.alpha, up.fall, up.rise, up.per_D, up.per_A}};
    J = jerk;
    per_J = 1 / jerk;
    return PlanResult::ok;
}

PlanResult plan(const MotionLimits& limits, const MotionState& from, const Goal& to,
                MotionPlan& out, const PlanOptions& options) {
    if (const PlanResult result = check(limits, from, to); result != PlanResult::ok) return result;
    Start start(limits, from, to, options);
    add_soonest(limits, start);
    return write(start.steps, limits, from, to, out);
}

PlanResult plan(const MotionLimits& limits, const MotionState& from, const Goal& to,
                double duration, MotionPlan& out, const PlanOptions& options) {
    if (!std::isfinite(duration)) return PlanResult::not_finite;
    if (const PlanResult result = check(limits, from, to); result != PlanResult::ok) return result;
    Start start(limits, from, to, options);
    const bool kept = add_timed(limits, start, duration - start.steps.duration);
    const PlanResult result = write(start.steps, limits, from, to, out);
    if (result == PlanResult::ok && kept) out.duration = duration;
    return result;
}

PlanResult synchronise(std::span<const AxisMove> axes, std::span<MotionPlan> out, double least,
                       const PlanOptions& options) {
    double duration = least;
    MotionPlan tried;
    for (const AxisMove& axis : axes) {
        const PlanResult result = plan(*axis.limits, axis.from, axis.to, duration, tried, options);
        if (result != PlanResult::ok) return result;
        duration = std::max(duration, tried.duration);
    }
    for (std::size_t i = 0, kept = 0; kept < axes.size(); i = (i + 1) % axes.size()) {
        const PlanResult result =
            plan(*axes[i].limits, axes[i].from, axes[i].to, duration, out[i], options);
        if (result != PlanResult::ok) return result;
        kept = out[i].duration > duration ? 1 : kept + 1;
        duration = out[i].duration;
    }
    return PlanResult::ok;
}

MotionState MotionPlan::at(double t) const {
    std::size_t phase = 0;
    return at(t, phase);
}

MotionState MotionPlan::at(double t, std::size_t& phase) const {
    if (!(t < duration)) {
        const double beyond = t - duration;
        return {end.position + end.velocity * beyond, end.velocity, 0, 0};
    }
    t = t > 0 ? t : 0;
    while (phase + 1 < count && t >= phases[phase + 1].begin) ++phase;
    while (phase > 0 && t < phases[phase].begin) --phase;
    MotionState s = phases[phase].start.after(t - phases[phase].begin);
    s.position += drift * t;
    return s;
}

double MotionPlan::greatest_velocity() const {
    double greatest = std::abs(end.velocity);
    for (std::size_t i = 0; i < count; ++i) {
        const MotionState& s = phases[i].start;
        greatest = std::max(greatest, std::abs(s.velocity));
        const double turn = -s.acceleration / s.jerk;
        if (s.jerk != 0 && turn > 0 && turn < phases[i].duration)
            greatest = std::max(greatest, std::abs(s.after(turn).velocity));
    }
    return greatest;
}

double MotionPlan::greatest_acceleration() const {
    double greatest = 0;
    for (std::size_t i = 0; i < count; ++i)
        greatest = std::max(greatest, std::abs(phases[i].start.acceleration));
    return greatest;
}

}  // namespace lineshaft

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

/// A number with twice the digits, for what is left of great terms that cancel.
struct Twice {
    double high, low = 0;

    static Twice sum(double a, double b, double low) {
        const double s = a + b;
        return {s, sum_error(a, b, s) + low};
    }
    friend Twice operator+(Twice a, Twice b) { return sum(a.high, b.high, a.low + b.low); }
    friend Twice operator-(Twice a, Twice b) { return sum(a.high, -b.high, a.low - b.low); }
    friend Twice operator*(Twice a, Twice b) {
        const double p = a.high * b.high;
        return sum(p, product_error(a.high, b.high, p) + (a.high * b.low + a.low * b.high), 0);
    }
    friend Twice operator/(Twice a, double b) {
        const double q = a.high / b;
        return sum(q, (a - Twice{q} * Twice{b}).value() / b, 0);
    }
    friend Twice root(Twice a) {
        const double r = std::sqrt(std::max(a.value(), 0.0));
        return r > 0 ? sum(r, (a - Twice{r} * Twice{r}).value() / (2 * r), 0) : Twice{0};
    }
    double value() const { return high + low; }
};

/// A motion as its jerks, with the acceleration at the end of each.
struct Steps {
    struct Step {
        double duration, jerk, acceleration;
        double x, v;  ///< at its start, the position counted from the first one's
    };
    std::array<Step, MotionPlan::most_phases + 1> list;
    std::size_t count = 0;
    double duration = 0;

    void add(double time, double jerk, double acceleration) {
        list[count].duration = time;
        list[count].jerk = jerk;
        list[count].acceleration = acceleration;
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
    double tau, vb, vt;  ///< a/J; velocities of the virtual point, and at the jerk time tau
    double Dv;           ///< vb - vf
    double ramp = 0;     ///< way of the direct ramp from the virtual point
    double miss = 0;     ///< from its end to the goal

    double vz() const { return a > 0 ? vt : vb; }  ///< with a at zero at once
};

Frame frame(const MotionLimits& limits, double sign, const MotionState& s, double vf, double way,
            double e) {
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
double reach(const Frame& f, const Peak& p) {
    return (f.vb + p.v) * (p.q + 0.5 * p.up_hold) + (p.v + f.vf) * (p.r + 0.5 * p.down_hold) +
           p.v * p.cruise;
}

/// The way left to the goal.
double left(const Frame& f, const Peak& p) {
    return f.miss - (reach(f, p) - f.ramp);
}

double time(const Peak& p) {
    return p.rise + p.up_hold + p.turn + p.cruise + p.down_hold + p.r;
}

/// The direct ramp.
Peak direct(const Frame& f) {
    if (f.e > 0 || (f.e == 0 && f.a < 0)) {
        const RampShape s = ramp_shape(f.a, f.e, f.side->A, f.J);
        return {s.to_peak, s.hold, s.to_zero, 0, 0, 0, s.to_zero, f.vf};
    }
    const RampShape s = ramp_shape(-f.a, -f.e, f.side->D, f.J);
    return {0, 0, f.tau, 0, s.to_zero, s.hold, s.to_peak, f.vt};
}

/// The same ramp in the mirrored frame.
Peak mirrored(const Frame& f, const Peak& p) {
    if (p.r == 0) return {0, 0, f.tau, 0, p.q, p.up_hold, p.rise, f.vt};
    return {p.turn, p.down_hold, p.r, 0, 0, 0, p.r, f.vf};
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
Peak over(const Frame& f, double v) {
    const Ramp up = ramp(v - f.vb, f.per_J, f.side->per_A, f.side->alpha, f.side->rise);
    const Ramp down = ramp(v - f.vf, f.per_J, f.side->per_D, f.side->delta, f.side->fall);
    const double q = std::max(up.jerk_time, f.tau);
    return {q - f.tau, up.hold, q, 0, down.jerk_time, down.hold, q + down.jerk_time, v};
}

/// A motion of the side, and which of its ramps stay as they are but for their holds when it gets
/// fuller.
struct Section {
    Peak from;
    bool up_held = false, down_held = false;
    double high = HUGE_VAL;  ///< what is unknown is no more
};

/// Both ramps triangular, the sum of their jerk times y longer.
Peak longer(const Frame& f, Peak p, double y) {
    if (!(y > 0)) return p;
    const double m = p.turn + y, half = 0.5 * y / m;
    const double up = half * (2 * p.r + y);
    p.v += f.J * up * (2 * p.q + up);
    p.rise += up;
    p.r = std::max(p.r + half * (2 * p.q + y), 0.0);
    p.q += up;
    p.turn = m;
    return p;
}

/// The way up triangular, its jerk time x longer, the way down held.
Peak longer_up(const Frame& f, Peak p, double x) {
    const double gain = f.J * x * (2 * p.q + x);
    p.down_hold = std::max(p.down_hold + gain * f.side->per_D, 0.0);
    p.v += gain;
    p.rise += x;
    p.q += x;
    p.turn += x;
    return p;
}

/// The way down triangular, its jerk time x longer, the way up held.
Peak longer_down(const Frame& f, Peak p, double x) {
    const double gain = f.J * x * (2 * p.r + x);
    p.up_hold += gain * f.side->per_A;
    p.v += gain;
    p.r += x;
    p.turn += x;
    return p;
}

/// Both ramps held, the peak faster by gain.
Peak faster(const Frame& f, Peak p, double gain) {
    p.up_hold += gain * f.side->per_A;
    p.down_hold += gain * f.side->per_D;
    p.v += gain;
    return p;
}

/// The q < 0 at which the hold of a dip ends, or 0.
double end_of_hold(const Frame& f) {
    const double square = f.side->delta * f.side->delta - f.Dv * f.per_J;
    return square > 0 ? -std::sqrt(square) : 0;
}

/// From a motion below V on over the shapes' borders that `beyond` tells to lie before the goal.
template <class Beyond>
Section section(const Frame& f, const Peak& from, const Beyond& beyond) {
    Section s{from};
    if (from.q < 0 && from.down_hold > 0) {
        const double q = end_of_hold(f);
        if (q < 0 && q > from.q) {
            Peak border = longer_up(f, from, q - from.q);
            if (!beyond(border)) return {from, false, true};
            border.down_hold = 0;
            s.from = border;
        }
    }
    const double start = std::max({f.vf, f.vz(), from.q > 0 ? from.v : f.vf});
    const double holds_up = f.vb + f.side->rise, holds_down = f.vf + f.side->fall;
    const bool up_first = holds_up < holds_down;
    for (const bool up : {up_first, !up_first}) {
        const double v = up ? holds_up : holds_down;
        if (v > start) {
            if (!(v < f.side->V)) break;
            Peak border = over(f, v);
            if (up) {
                border.q = f.side->alpha;
                border.rise = border.q - f.tau;
                border.up_hold = 0;
            } else {
                border.r = f.side->delta;
                border.down_hold = 0;
            }
            border.turn = border.q + border.r;
            if (!beyond(border)) break;
            s.from = border;
        }
        (up ? s.up_held : s.down_held) = true;
    }
    return s;
}

/// The motion of the section that goes `miss` farther.
Peak farther(const Frame& f, const Section& s, double miss) {
    const Peak& p = s.from;
    const MotionLimits::Side& side = *f.side;
    const auto high = [&](double x) { return std::min(std::max(x, 0.0), s.high); };
    if (!(miss > 0)) return p;
    if (s.up_held && s.down_held) {
        const double curvature = side.per_A + side.per_D;
        const double slope = p.v * curvature + 0.5 * (side.alpha + side.delta);
        const double root = std::sqrt(slope * slope + 2 * curvature * miss);
        return faster(f, p, slope > 0 ? 2 * miss / (slope + root) : (root - slope) / curvature);
    }
    if (s.down_held)
        return longer_up(
            f, p,
            mixed_step({f.J, p.v, p.q, p.r, p.turn}, side.delta, miss, high(side.alpha - p.q)));
    if (s.up_held)
        return longer_down(
            f, p,
            mixed_step({f.J, p.v, p.r, p.q, p.turn}, side.alpha, miss, high(side.delta - p.r)));
    return longer(f, p,
                  triangular_step({f.J, p.v, p.q, p.r, p.turn}, miss,
                                  high(side.alpha + side.delta - p.turn)));
}

/// The motion of the section that lasts `time` longer.
Peak longer_lasting(const Frame& f, const Section& s, double time) {
    const Peak& p = s.from;
    const MotionLimits::Side& side = *f.side;
    const auto step = [&](double q, double t) {
        const double u = 1 + q / t;
        return time / (u + std::sqrt(u * u + time / t));
    };
    if (!(time > 0)) return p;
    if (s.up_held && s.down_held) return faster(f, p, time / (side.per_A + side.per_D));
    if (s.down_held) return longer_up(f, p, step(p.q, side.delta));
    if (s.up_held) return longer_down(f, p, step(p.r, side.alpha));
    return longer(f, p, 0.5 * time);
}

/// How much longer q, or q + r, is where the way in a dip is greatest.
double top_of_dip(const Frame& f, const Section& s) {
    if (s.down_held) {
        const double square = f.side->D * f.side->D - 16 * f.J * f.vb;
        return square > 0 ? -0.25 * (f.side->D + std::sqrt(square)) * f.per_J - s.from.q : 0;
    }
    const double S = f.vb + f.vf, square = 4 * S * S - 3 * f.Dv * f.Dv;
    if (!(S < 0 && square > 0)) return 0;
    return std::sqrt((-2 * S - std::sqrt(square)) * (1.0 / 3) * f.per_J) - s.from.turn;
}

/// For vf < 0 the way has a greatest value in a dip at most: whether the goal is hit before.
bool hits_in_dip(const Frame& f, const Peak& from, Section& s) {
    s = {from, false, from.down_hold > 0};
    if (s.down_held) {
        const double last = end_of_hold(f), end = last - from.q, top = top_of_dip(f, s);
        s.high = top > 0 && top < end ? top : end;
        if (s.high > 0 && left(f, longer_up(f, from, s.high)) <= 0) return true;
        if (last == 0) return false;
        s = {longer_up(f, from, std::max(end, 0.0))};
        s.from.down_hold = 0;
    }
    s.high = top_of_dip(f, s);
    const Peak highest = longer(f, s.from, s.high);
    return s.high > 0 && highest.q < 0 && left(f, highest) <= 0;
}

/// The first motion after `from` that ends at the goal.
Peak solve(const Frame& f, const Peak& from) {
    Section s;
    if (f.vf < 0 && from.q < 0 && hits_in_dip(f, from, s)) return farther(f, s, left(f, s.from));
    Peak fullest = over(f, std::max(f.side->V, f.vz()));
    const double rest = left(f, fullest);
    if (rest < 0 && (from.q < 0 || std::max(f.vf, f.vz()) < f.side->V)) {
        s = section(f, from, [&](const Peak& border) { return left(f, border) > 0; });
        return farther(f, s, left(f, s.from));
    }
    fullest.cruise = std::max(rest, 0.0) / fullest.v;
    return fullest;
}

/// The motion to the greatest position that is reached in a time.
Peak timed(const Frame& f, const Peak& from, double duration) {
    Peak fullest = over(f, std::max(f.side->V, f.vz()));
    const double rest = duration - time(fullest);
    if (rest < 0 && (from.q < 0 || std::max(f.vf, f.vz()) < f.side->V)) {
        const Section s =
            section(f, from, [&](const Peak& border) { return time(border) < duration; });
        return longer_lasting(f, s, duration - time(s.from));
    }
    fullest.cruise = std::max(rest, 0.0);
    return fullest;
}

/// What rounding takes from one jerk time the later ones make up for. Where acceleration left over
/// would matter in a hold or a cruise, a phase as short as the rounding frees it of that before.
void fit(const Frame& f, double a_rest, Peak& p) {
    if (!(p.up_hold > 0 || p.down_hold > 0 || p.cruise > 0)) return;
    const double grain = ulp * f.per_J * std::max({std::abs(f.v), std::abs(f.vf), std::abs(p.v)});
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
    const double r = p.turn - sum;
    const double left_over = (r - p.r) + (sum_error(p.turn, -sum, r) - rest);
    if (matters(left_over, p.down_hold))
        p.turn_rest = -left_over;
    else
        p.r += left_over;
}

/// The cruise makes up for what rounding does to the ramps.
void fit_cruise(const Frame& f, Peak& p) {
    MotionState s{0, f.v, f.a, f.J};
    s = s.after(p.rise);
    s = MotionState{s.position, s.velocity, f.J * p.q, 0}.after(p.up_hold);
    s = MotionState{s.position, s.velocity, f.J * p.q, -f.J}.after(p.q);
    const double down = (p.v + f.vf) * (p.r + 0.5 * p.down_hold);
    p.cruise = std::max(f.way - s.position - down, 0.0) / p.v;
}

void add(const Frame& f, const Peak& p, Steps& steps) {
    const double J = f.sign * f.J, up = J * p.q, down = -J * p.r;
    const auto add_rest = [&](double rest, double jerk, double acceleration) {
        if (rest != 0) steps.add(std::abs(rest), std::copysign(jerk, rest * jerk), acceleration);
    };
    steps.add(p.rise, J, up);
    add_rest(p.rise_rest, J, up);
    steps.add(p.up_hold, 0, up);
    if (p.cruise > 0) {
        steps.add(p.q, -J, 0);
        add_rest(p.turn_rest, -J, 0);
        steps.add(p.cruise, 0, 0);
        steps.add(p.r, -J, down);
    } else {
        steps.add(p.turn, -J, down);
        add_rest(p.turn_rest, -J, down);
    }
    steps.add(p.down_hold, 0, down);
    steps.add(p.r, J, 0);
}

/// Along `sign`: the velocity above the limit once a is at zero.
double excess(const MotionLimits& limits, const MotionState& s, double sign) {
    const double v = sign * s.velocity, a = sign * s.acceleration;
    return (v - limits.side[sign < 0].V) + 0.5 * a * std::abs(a) * limits.per_J;
}

/// A state under way back inside its limits, its position counted from the first one's. With twice
/// the digits: what is left of a far too great velocity is small beside it.
struct Return {
    const MotionLimits& limits;
    Steps& steps;
    Twice x, v, a;
    MotionState s;

    Return(const MotionLimits& l, Steps& list, const MotionState& from)
        : limits(l),
          steps(list),
          x{0},
          v{from.velocity},
          a{from.acceleration},
          s{0, from.velocity, from.acceleration, 0} {}

    [[gnu::noinline]] void run(double time, double jerk) {
        if (!(time > 0)) return;
        const Twice t{time}, j{jerk};
        x = x + t * (v + t * (a + t * j / 3) * Twice{0.5});
        v = v + t * (a + t * j * Twice{0.5});
        a = a + t * j;
        s = {x.value(), v.value(), a.value(), 0};
        steps.add(time, jerk, s.acceleration);
    }

    /// What rounding has left of the acceleration beside that of the state.
    double a_rest() const { return (a - Twice{s.acceleration}).value(); }

    /// Until V is joined tangentially: the velocity ramp to it without its last jerk.
    void gently(double sign, double over) {
        const RampShape ramp =
            ramp_shape(-sign * s.acceleration, over, limits.side[sign < 0].D, limits.J);
        run(ramp.to_peak, -sign * limits.J);
        run(ramp.hold, 0);
    }

    /// Until V is kept, or the limit of the other side could not be any more.
    void soon(double sign) {
        const MotionLimits::Side& side = limits.side[sign < 0];
        const double back = limits.side[sign > 0].V, J = limits.J;
        const double v0 = sign * s.velocity, a0 = sign * s.acceleration;
        const double keeps = std::sqrt(std::max(a0 * a0 + 2 * J * (v0 - side.V), 0.0));
        const double turns = std::sqrt(std::max(0.5 * a0 * a0 + J * (v0 + back), 0.0));
        const double peak = std::min({keeps, turns, side.D});
        run((a0 + peak) * limits.per_J, -sign * J);
        if (peak < side.D) return;
        const double now = sign * s.velocity;
        run(std::min(now - side.V, now + back - 0.5 * side.fall) * side.per_D, 0);
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
    Return back(limits, steps, from);
    for (const double sign : {1.0, -1.0}) {
        const MotionLimits::Side& side = limits.side[sign < 0];
        const double room = slack * std::max(side.V, std::abs(from.velocity));
        if (sign * back.s.acceleration > side.A * (1 + slack) &&
            excess(limits, back.s, sign) <= room)
            back.run((sign * back.s.acceleration - side.A) * limits.per_J, -sign * limits.J);
    }
    // The limit that it will pass comes before the one that it has passed and is leaving.
    const double towards = std::copysign(1.0, back.s.acceleration);
    for (const double sign : {towards, -towards}) {
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
    a_rest = back.a_rest();
    return back.s;
}

/// The mean of two motions of equal duration, one of weight lambda. Where acceleration left over by
/// rounding would change the velocity of a hold by more than `grain`, a short phase frees it of
/// that.
void blend(const Steps& one, const Steps& other, double lambda, Twice a, double J, double grain,
           Steps& out) {
    const auto mean = [&](double x, double y) { return lambda * x + (1 - lambda) * y; };
    std::size_t i = 0, k = 0;
    double left_i = one.list[0].duration, left_k = other.list[0].duration;
    double a_i = a.high, a_k = a.high, begin = a.high;
    while (i < one.count && k < other.count) {
        const Steps::Step &x = one.list[i], &y = other.list[k];
        const double time = std::min(left_i, left_k), jerk = mean(x.jerk, y.jerk);
        const double rest = (Twice{begin} - a).value();
        if (jerk == 0 && std::abs(rest) * time > grain) {
            out.add(std::abs(rest) / J, std::copysign(J, rest), begin);
            a = {begin};
        }
        const bool ends_i = left_i <= time, ends_k = left_k <= time;
        a_i = ends_i ? x.acceleration : a_i + x.jerk * time;
        a_k = ends_k ? y.acceleration : a_k + y.jerk * time;
        begin = mean(a_i, a_k);
        out.add(time, jerk, begin);
        a = a + Twice{time} * Twice{jerk};
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

/// Runs the steps forwards to the last one, which is run back from the end: a state within it is
/// as near to the goal as rounding allows. `duration` is what their sum stands for. Refuses what
/// misses by more than rounding can tell: the numbers are too many decades apart.
PlanResult write(Steps& steps, const MotionState& from, const Goal& to, double duration,
                 MotionPlan& out) {
    constexpr double most = 1e-6;
    double x = 0, v = from.velocity, a = from.acceleration, path = 0;
    double fastest = std::max(std::abs(v), std::abs(to.velocity));
    MotionState back{0, to.velocity, 0, 0};
    for (std::size_t i = 0; i < steps.count; ++i) {
        Steps::Step& step = steps.list[i];
        step.x = x;
        step.v = v;
        if (i + 1 == steps.count) {
            back = MotionState{0, to.velocity, 0, step.jerk}.after(-step.duration);
            break;
        }
        const MotionState end = MotionState{x, v, a, step.jerk}.after(step.duration);
        path += std::abs(end.position - x);
        fastest = std::max(fastest, std::abs(end.velocity));
        x = end.position;
        v = end.velocity;
        a = step.acceleration;
    }
    const double missed = ((to.position - from.position) + back.position) - x;
    const double size =
        std::max({std::abs(from.position), std::abs(to.position), path + std::abs(back.position)});
    if (!(std::abs(missed) <= most * size && std::abs(back.velocity - v) <= most * fastest &&
          std::abs(duration - steps.duration) <= most * duration &&
          std::isfinite(size + fastest * duration)))
        return PlanResult::not_finite;
    out.phases[0] = {0, 0, from};
    double begin = 0;
    a = from.acceleration;
    for (std::size_t i = 0; i < steps.count; ++i) {
        const Steps::Step& step = steps.list[i];
        out.phases[i] = {begin, step.duration, {from.position + step.x, step.v, a, step.jerk}};
        begin += step.duration;
        a = step.acceleration;
    }
    if (steps.count > 1) {
        MotionState& last = out.phases[steps.count - 1].start;
        last.position = to.position + back.position;
        last.velocity = back.velocity;
    }
    out.count = steps.count;
    out.duration = duration;
    out.missed = steps.count > 1 ? missed : 0;
    out.haste = duration > 0 ? MotionPlan::spread / duration : 0;
    out.end = {to.position, to.velocity, 0, 0};
    return PlanResult::ok;
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
        const double a = state.acceleration, tau = std::abs(a) * limits.per_J;
        const double e = (vf - state.velocity) - 0.5 * a * tau;
        if (a == 0 && e == 0) return 0;
        const double v = std::max(std::abs(state.velocity), std::abs(vf));
        if (std::abs(e) > slack * std::max(v, std::abs(a) * tau)) return e;
        const double x = tau * (state.velocity + a * tau * (1.0 / 3));
        const double size = std::max({std::abs(from.position), std::abs(to.position), v * tau});
        if (std::abs(way - x) <= slack * size) return 0;
        return exact_missing(limits.J);
    }

    [[gnu::cold]] double exact_missing(double J) const {
        const double a = state.acceleration;
        return (Twice{vf} - Twice{state.velocity} - Twice{a} * Twice{0.5 * std::abs(a)} / J)
            .value();
    }

    /// From the end of the direct ramp to the goal with twice the digits: near the optimum's jump
    /// the duration changes with its cube root.
    [[gnu::cold]] double exact_miss(const MotionState& from, const Goal& to) const {
        const bool up = ramp.r == 0;
        const double sign = up ? 1 : -1, limit = up ? ahead.side->A : ahead.side->D;
        const Twice a{ahead.a}, v{ahead.v}, goal{vf}, tau = a * Twice{sign} / ahead.J;
        const Twice foot = v - a * tau * Twice{0.5}, dv = (goal - foot) * Twice{sign};
        const Twice half = ramp.up_hold > 0 || ramp.down_hold > 0
                               ? (Twice{limit} / ahead.J + dv / limit) * Twice{0.5}
                               : root(dv / ahead.J);
        const Twice missed = Twice{to.position} - Twice{from.position} - Twice{state.position} +
                             tau * (v - a * tau / 3) - (foot + goal) * half;
        return missed.value();
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
        const double grain = ulp * std::max({std::abs(from.position), std::abs(to.position), path});
        tolerance = options.tolerance * grain;
        ahead.ramp = reach(ahead, ramp);
        ahead.miss = way + ahead.tau * (ahead.v - ahead.a * ahead.tau * (1.0 / 3)) - ahead.ramp;
        if (std::abs(ahead.miss) > tolerance && std::abs(ahead.miss) < 0x1p20 * grain)
            ahead.miss = exact_miss(from, to);
    }

    double duration() const { return time(ramp); }
    Frame back(const MotionLimits& limits) const {
        Frame f = frame(limits, -1, state, vf, way, ahead.e);
        f.ramp = reach(f, mirrored(f, ramp));
        f.miss = -ahead.miss;
        return f;
    }
};

/// The first motion of the frame's side after `from` that ends at the goal.
void add_solved(const Frame& f, const Peak& from, Start& start) {
    Peak p = solve(f, from);
    fit(f, start.a_rest, p);
    if (p.cruise > 0) fit_cruise(f, p);
    add(f, p, start.steps);
}

void add_soonest(const MotionLimits& limits, Start& start) {
    const double missing = start.ahead.miss;
    if (std::abs(missing) <= start.tolerance) {
        Peak p = start.ramp;
        fit(start.ahead, start.a_rest, p);
        add(start.ahead, p, start.steps);
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
        return false;
    }
    const Frame back = start.back(limits);
    const Peak up = timed(start.ahead, start.ramp, duration);
    const Peak down = timed(back, mirrored(back, start.ramp), duration);
    const double above = left(start.ahead, up);
    const double below = left(back, down);
    if (above > start.tolerance || below > start.tolerance) {
        if (above > start.tolerance)
            add_solved(start.ahead, up, start);
        else
            add_solved(back, down, start);
        return false;
    }
    Steps upper, lower;
    add(start.ahead, up, upper);
    add(back, down, lower);
    const double room = -above - below;
    const double lambda = room > 0 ? std::min(std::max(-below / room, 0.0), 1.0) : 1;
    const double velocity = std::max({std::abs(up.v), std::abs(down.v), std::abs(start.vf)});
    blend(upper, lower, lambda, {start.state.acceleration, start.a_rest}, limits.J, ulp * velocity,
          start.steps);
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
    return write(start.steps, from, to, start.steps.duration, out);
}

PlanResult plan(const MotionLimits& limits, const MotionState& from, const Goal& to,
                double duration, MotionPlan& out, const PlanOptions& options) {
    if (!std::isfinite(duration)) return PlanResult::not_finite;
    if (const PlanResult result = check(limits, from, to); result != PlanResult::ok) return result;
    Start start(limits, from, to, options);
    const bool kept = add_timed(limits, start, duration - start.steps.duration);
    const double taken = kept ? duration : std::max(start.steps.duration, duration);
    return write(start.steps, from, to, taken, out);
}

PlanResult synchronise(std::span<const AxisMove> axes, std::span<MotionPlan> out, double least,
                       const PlanOptions& options) {
    double duration = least;
    MotionPlan tried;
    for (std::size_t i = 0, kept = 0; kept < axes.size(); i = (i + 1) % axes.size()) {
        const AxisMove& axis = axes[i];
        const PlanResult result = plan(*axis.limits, axis.from, axis.to, duration, tried, options);
        if (result != PlanResult::ok) return result;
        kept = tried.duration > duration ? 1 : kept + 1;
        duration = tried.duration;
    }
    for (std::size_t i = 0; i < axes.size(); ++i)
        plan(*axes[i].limits, axes[i].from, axes[i].to, duration, out[i], options);
    return PlanResult::ok;
}

MotionState MotionPlan::at(double t) const {
    std::size_t phase = 0;
    return at(t, phase);
}

MotionState MotionPlan::look_up(double t, std::size_t& phase) const {
    if (!(t < duration)) {
        const double beyond = t - duration;
        return {end.position + end.velocity * beyond, end.velocity, 0, 0};
    }
    if (!(t > 0)) return phases[0].start;
    while (phase + 1 < count && t >= phases[phase + 1].begin) ++phase;
    while (phase > 0 && t < phases[phase].begin) --phase;
    const Phase& now = phases[phase];
    if (phase + 1 == count)
        return MotionState{end.position, end.velocity, 0, now.start.jerk}.after(t - duration);
    return within(now, t);
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

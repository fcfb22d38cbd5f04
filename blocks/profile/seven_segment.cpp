#include "blocks/profile/seven_segment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks/profile/peak_equations.hpp"

namespace lineshaft {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

bool is_limit(double x) {
    return x > 0 && x <= std::numeric_limits<double>::max();
}

/// Rounding can make a time negative; NaN stays, unlike with the arguments the other way round.
double above_zero(double x) {
    return std::max(x, 0.0);
}
double between(double x, double low, double high) {
    return std::max(std::min(x, high), low);
}

struct Ramp {
    double jerk_time = 0;  // twice
    double hold = 0;

    double half_time() const { return jerk_time + 0.5 * hold; }
};

struct Move {
    std::array<Ramp, 2> ramps;  // up, down
    double cruise = 0;
    double peak = 0;
    double end = 0;
    MoveKind kind = MoveKind::accelerate_triangular;
    bool reaches_Ve = true;
};

/// The problem seen from its slower end: time reversal leaves lengths and times as they are.
struct Frame {
    double lo, hi, D, A, J, L;
    double tm;  // A/J
    double c;   // A^2/J, the change of velocity from which a ramp is trapezoidal
};

Ramp ramp(double dv, const Frame& f) {
    if (dv > f.c) return {f.tm, above_zero(dv / f.A - f.tm)};
    return {std::sqrt(dv / f.J), 0};
}

/// What is missing to dv after a triangular ramp whose time t has been rounded.
double shortfall(double dv, double t, double J) {
    const double tt = t * t;
    const double v = J * tt;
    return (dv - v) - (product_error(J, tt, v) + J * product_error(t, t, tt));
}

Ramp accelerate(double V, const Frame& f) {
    if (f.L > (2 * V + f.c) * f.tm) {
        const double b = 2 * V + f.c;
        const double R = 2 * (f.L - V * f.tm);
        return {f.tm, above_zero(2 * R / (b + std::sqrt(b * b + 4 * f.A * R)) - f.tm)};
    }
    const double high = f.L / (2 * V) < f.tm ? f.L / (2 * V) : f.tm;
    const double guess = rough_root(f.J, 2 * V, rough_cube_root(f.L / f.J));
    return {rising_root({0, f.J, 0, 2 * V, -f.L}, guess, householder_near, 0, high), 0};
}

/// Near the greatest length that a deceleration can cover the time changes with the square root of
/// the length that is left; there the length s (2V - J s^2) is taken with twice the digits.
double refine_near_turn(double s, double V, const Frame& f, double high) {
    for (int i = 0; i < 6; ++i) {
        const double slope = 2 * V - 3 * f.J * s * s;
        if (slope <= 0) break;
        const double change = f.J * (s * s);
        const double mean = 2 * V - change;
        const double lost = ((2 * V - mean) - change) + shortfall(change, s, f.J);
        const double length = s * mean;
        const double missing = (f.L - length) - (product_error(s, mean, length) + s * lost);
        s = between(s + missing / slope, 0, high);
    }
    return s;
}

/// (2V + c)^2 - 8 A L with twice the digits: it vanishes at the greatest length of a deceleration.
double discriminant(double V, const Frame& f) {
    const double AA = f.A * f.A;
    const double c = AA / f.J;
    const double Jc = f.J * c;
    const double c_rest =
        (((AA - Jc) - product_error(f.J, c, Jc)) + product_error(f.A, f.A, AA)) / f.J;
    const double b = 2 * V + c;
    const double b_rest = (c - (b - 2 * V)) + c_rest;
    const double bb = b * b;
    const double AL = f.A * f.L;
    return (bb - 8 * AL) +
           (product_error(b, b, bb) + 2 * b * b_rest - 8 * product_error(f.A, f.L, AL));
}

Ramp decelerate(double V, const Frame& f) {
    if (V > 1.5 * f.c && f.L > (2 * V - f.c) * f.tm) {
        const double b = 2 * V - f.c;
        const double R = 2 * (f.L - V * f.tm);
        const double rough = b * b - 4 * f.A * R;
        const double square = rough > 1e-2 * b * b ? rough : discriminant(V, f);
        const double y = 2 * R / (b + std::sqrt(above_zero(square)));
        return {f.tm, above_zero(y - f.tm)};
    }
    const double high = std::sqrt(V / (1.5 * f.J));
    const double m = std::sqrt(above_zero(1 - 0.75 * f.L / (V * high)));
    const double guess = high * (1 - m) * (1 + m * (0.174 + 0.147 * m));
    const double near = householder_near * std::min(1.0, (high - guess) / guess);
    const double s = rising_root({0, -f.J, 0, 2 * V, -f.L}, guess, near, 0, high);
    return {m > 1e-2 ? s : refine_near_turn(s, V, f, high), 0};
}

/// The ramps from hi and from lo to the peak, one problem in two times.
struct Ramps {
    Ramp from_hi, from_lo;
};

Ramps both_trapezoidal(const Frame& f) {
    const double b = 2 * f.hi + f.c;
    const double R = f.L - f.hi * f.tm - 0.5 * (f.lo + f.hi) * (f.tm + f.D / f.A);
    const double hold = above_zero(2 * R / (b + std::sqrt(b * b + 4 * f.A * R)) - f.tm);
    return {{f.tm, hold}, {f.tm, hold + f.D / f.A}};
}

Ramps one_trapezoidal(const Frame& f) {
    const double rest = f.L - 0.5 * (f.lo + f.hi) * (f.tm + f.D / f.A);
    const double s = mixed_step({f.J, f.hi, 0, 0, 0}, f.tm, rest, f.tm);
    return {{s, 0}, {f.tm, above_zero((f.D + f.J * s * s) / f.A - f.tm)}};
}

Ramps neither_trapezoidal(const Frame& f) {
    const double q = std::sqrt(f.D / f.J);
    const double y = triangular_step({f.J, f.hi, q, 0, q}, f.L - (f.lo + f.hi) * q, 2 * f.tm - q);
    const double half = 0.5 * y / (q + y);
    return {{half * (2 * q + y), 0}, {q + half * y, 0}};
}

/// How many of the two ramps to a peak below Vm are triangular: the length at the borders decides.
int triangular_ramps(double Vm, const Frame& f) {
    if (Vm - f.hi > f.c) {
        const double w = f.D + f.c;
        const double length =
            (2 * f.hi + f.c) * f.tm + (f.lo + f.hi + f.c) * 0.5 * (w / f.A + f.tm);
        if (f.L > length) return 0;
    }
    if (f.D >= f.c) return 1;
    if (Vm - f.lo > f.c) {
        const double w = f.c - f.D;
        const double length = (2 * f.hi + w) * std::sqrt(w / f.J) + (2 * f.lo + f.c) * f.tm;
        if (f.L > length) return 1;
    }
    return 2;
}

/// The kinds of a family stand in the order of their triangular ramps: none, one, both.
MoveKind kind_of(MoveKind family, int triangular) {
    return static_cast<MoveKind>(static_cast<int>(family) + triangular);
}

Move one_ramp(const SevenSegment& p, const Frame& f, const Ramp& direct, bool reached) {
    Move m;
    m.reaches_Ve = reached;
    const bool rising = p.Ve >= p.Vs;
    const Ramp r = reached ? direct : rising ? accelerate(p.Vs, f) : decelerate(p.Vs, f);
    m.ramps[rising ? 0 : 1] = r;
    const double change = f.J * r.jerk_time * (r.jerk_time + r.hold);
    m.end = reached ? p.Ve : rising ? std::min(p.Ve, p.Vs + change) : std::max(p.Ve, p.Vs - change);
    m.peak = std::max(p.Vs, m.end);
    m.kind = kind_of(rising ? MoveKind::accelerate_trapezoidal : MoveKind::decelerate_trapezoidal,
                     r.hold > 0 ? 0 : 1);
    return m;
}

Move with_peak(const SevenSegment& p, const Frame& f) {
    const int triangular = triangular_ramps(p.Vm, f);
    const Ramps r = triangular == 0   ? both_trapezoidal(f)
                    : triangular == 1 ? one_trapezoidal(f)
                                      : neither_trapezoidal(f);
    Move m;
    const bool rising = p.Ve >= p.Vs;
    m.ramps[rising ? 0 : 1] = r.from_lo;
    m.ramps[rising ? 1 : 0] = r.from_hi;
    m.peak =
        std::min(p.Vm, f.hi + f.J * r.from_hi.jerk_time * (r.from_hi.jerk_time + r.from_hi.hold));
    m.end = p.Ve;
    m.kind = kind_of(rising ? MoveKind::peak_rising_both : MoveKind::peak_falling_both, triangular);
    return m;
}

double length_through_Vm(const SevenSegment& p, const Move& m) {
    return (p.Vs + p.Vm) * m.ramps[0].half_time() + (p.Vm + p.Ve) * m.ramps[1].half_time();
}

/// The longer of two triangular ramps makes up for what rounding takes from the shorter, so
/// that the end velocity bears one rounding only.
void match_triangles(const SevenSegment& p, Move& m) {
    const double rise = p.Vm - p.Vs;
    const double fall = p.Vm - p.Ve;
    if (fall > rise)
        m.ramps[1].jerk_time = std::sqrt((fall - shortfall(rise, m.ramps[0].jerk_time, p.J)) / p.J);
    else
        m.ramps[0].jerk_time = std::sqrt((rise - shortfall(fall, m.ramps[1].jerk_time, p.J)) / p.J);
}

Move with_cruise(const SevenSegment& p, Move m) {
    const int triangular = 2 - (m.ramps[0].hold > 0) - (m.ramps[1].hold > 0);
    if (triangular == 2 && p.Vs != p.Ve) match_triangles(p, m);
    m.cruise = above_zero(p.L - length_through_Vm(p, m)) / p.Vm;
    m.peak = p.Vm;
    m.end = p.Ve;
    const bool rising = p.Ve >= p.Vs;
    m.kind =
        kind_of(rising ? MoveKind::cruise_rising_both : MoveKind::cruise_falling_both, triangular);
    return m;
}

/// Nothing moves: the squares and cubes of such a length and of its times would be lost.
constexpr double no_length = 1e-100;

Move without_length(const SevenSegment& p) {
    Move m;
    m.peak = m.end = p.Vs;
    m.reaches_Ve = p.Vs == p.Ve;
    m.kind = p.Ve >= p.Vs ? MoveKind::accelerate_triangular : MoveKind::decelerate_triangular;
    return m;
}

Move solve(const SevenSegment& p) {
    if (p.L < no_length) return without_length(p);
    const double tm = p.A / p.J;
    const double lo = std::min(p.Vs, p.Ve);
    const double hi = std::max(p.Vs, p.Ve);
    const Frame f{lo, hi, hi - lo, p.A, p.J, p.L, tm, p.A * tm};

    const Ramp direct = ramp(f.D, f);
    const double L1 = (lo + hi) * direct.half_time();
    if (p.L <= L1) return one_ramp(p, f, direct, p.L >= L1 * (1 - 2 * epsilon));

    Move m;
    m.ramps[0] = ramp(p.Vm - p.Vs, f);
    m.ramps[1] = ramp(p.Vm - p.Ve, f);
    const double L2 = length_through_Vm(p, m);
    return p.L >= L2 * (1 - epsilon) ? with_cruise(p, m) : with_peak(p, f);
}

/// 0 for -0, of which a quotient would be infinite on the wrong side.
SevenSegment without_negative_zeros(SevenSegment p) {
    for (double* quantity : {&p.Vs, &p.Ve, &p.L}) *quantity += 0.0;
    return p;
}

PlanResult check(const SevenSegment& p) {
    if (!is_limit(p.Vm) || !is_limit(p.A) || !is_limit(p.J)) return PlanResult::limit_not_positive;
    if (!std::isfinite(p.Vs) || !std::isfinite(p.Ve) || !std::isfinite(p.L))
        return PlanResult::not_finite;
    if (p.Vs < 0 || p.Ve < 0 || p.Vs > p.Vm || p.Ve > p.Vm) return PlanResult::velocity_above_limit;
    return p.L < 0 ? PlanResult::negative_length : PlanResult::ok;
}

/// The first half counts from the start, the second half back from the end: both ends are exact.
void fill_states(const SevenSegment& p, const Move& m, SevenSegmentPlan& out) {
    auto& s = out.start;
    const auto& T = out.T;
    const auto turn = [](MotionState state, double acceleration, double jerk) {
        return MotionState{state.position, state.velocity, acceleration, jerk};
    };
    const double up = p.J * T[0];
    s[0] = {0, p.Vs, 0, p.J};
    s[1] = turn(s[0].after(T[0]), up, 0);
    s[2] = turn(s[1].after(T[1]), up, -p.J);
    s[3] = {s[2].after(T[2]).position, m.peak, 0, 0};
    const double down = p.J * T[6];
    const MotionState back{0, m.end, 0, p.J};  // the second half in reversed time and position
    const MotionState b6 = back.after(T[6]);
    const MotionState b5 = turn(b6, down, 0).after(T[5]);
    const MotionState b4 = turn(b5, down, -p.J).after(T[4]);
    s[4] = {p.L - b4.position, m.peak, 0, -p.J};
    s[5] = {p.L - b5.position, b5.velocity, -down, 0};
    s[6] = {p.L - b6.position, b6.velocity, -down, p.J};
    out.end = {p.L, m.end, 0, 0};
}

}  // namespace

PlanResult plan(const SevenSegment& problem, SevenSegmentPlan& out) {
    const PlanResult result = check(problem);
    if (result != PlanResult::ok) return result;
    const Move m = solve(without_negative_zeros(problem));
    const double up = 2 * m.ramps[0].half_time();
    const double down = 2 * m.ramps[1].half_time();
    const double duration = up + m.cruise + down;
    if (!std::isfinite(duration)) return PlanResult::not_finite;

    out.T = {m.ramps[0].jerk_time, m.ramps[0].hold, m.ramps[0].jerk_time, m.cruise,
             m.ramps[1].jerk_time, m.ramps[1].hold, m.ramps[1].jerk_time};
    for (std::size_t i = 0; i < 7; ++i) out.begin[i + 1] = out.begin[i] + out.T[i];
    out.duration = out.begin[7];
    out.peak = m.peak;
    out.kind = m.kind;
    out.reaches_Ve = m.reaches_Ve;
    fill_states(problem, m, out);
    return PlanResult::ok;
}

MotionState SevenSegmentPlan::at(double t) const {
    if (t >= duration) return end;
    const double time = t > 0 ? t : 0;
    std::size_t i = time >= begin[4] ? 4 : 0;
    i += time >= begin[i + 2] ? 2 : 0;
    i += time >= begin[i + 1] ? 1 : 0;
    return start[i].after(time - begin[i]);
}

double SevenSegmentPlan::displacement_error() const {
    long double x = 0, v = start[0].velocity, a = 0;
    for (std::size_t i = 0; i < 7; ++i) {
        const long double t = T[i], j = start[i].jerk;
        x += t * (v + t * (a / 2 + t * j / 6));
        v += t * (a + t * j / 2);
        a += t * j;
    }
    return static_cast<double>(std::abs(x - end.position));
}

std::string_view name(MoveKind kind) {
    return move_kind_names[static_cast<std::size_t>(kind)];
}

int equation(MoveKind kind) {
    static constexpr std::array<int, move_kinds> equations = {1, 2, 3, 4,  5,  6, 8,  5,
                                                              7, 8, 9, 10, 11, 9, 10, 11};
    return equations[static_cast<std::size_t>(kind)];
}

}  // namespace lineshaft

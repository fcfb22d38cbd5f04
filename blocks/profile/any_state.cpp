#include "blocks/profile/any_state.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "blocks/profile/motion_track.hpp"
#include "blocks/profile/peak_motion.hpp"
#include "blocks/profile/standstill.hpp"
#include "blocks/profile/twice.hpp"

namespace lineshaft {
namespace {

using namespace peak_motion;

/// Along `sign`: the velocity above the limit once a is at zero.
double excess(const MotionLimits& limits, const MotionState& s, double sign) {
    const double v = sign * s.velocity, a = sign * s.acceleration;
    return (v - limits.side[sign < 0].V) + 0.5 * a * std::abs(a) * limits.per_J;
}

/// A state under way back inside its limits, its position counted from the first one's. With twice
/// the digits: what is left of a far too great velocity is small beside it.
struct Return {
    const MotionLimits& limits;
    Track& track;
    Twice x, v, a;
    MotionState s;

    Return(const MotionLimits& l, Track& to, const MotionState& from)
        : limits(l),
          track(to),
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
        track.add(time, jerk, s.acceleration);
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
                  Track& track, double& a_rest) {
    if (is_inside(limits, from)) return {0, from.velocity, from.acceleration, 0};
    const double slack = options.tolerance * ulp;
    Return back(limits, track, from);
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
           Track& track) {
    const auto mean = [&](double x, double y) { return lambda * x + (1 - lambda) * y; };
    const Steps::Step *x = one.list.data(), *y = other.list.data();
    const Steps::Step *const end_x = x + one.count, *const end_y = y + other.count;
    double left_x = x->duration, left_y = y->duration;
    double a_x = a.high, a_y = a.high, begin = a.high;
    Track out = track;
    while (x != end_x && y != end_y) {
        const double time = std::min(left_x, left_y), jerk = mean(x->jerk, y->jerk);
        const double rest = (Twice{begin} - a).value();
        if (jerk == 0 && std::abs(rest) * time > grain) {
            out.add(std::abs(rest) / J, std::copysign(J, rest), begin);
            a = {begin};
        }
        const bool ends_x = left_x <= time, ends_y = left_y <= time;
        a_x = ends_x ? x->acceleration : a_x + x->jerk * time;
        a_y = ends_y ? y->acceleration : a_y + y->jerk * time;
        begin = mean(a_x, a_y);
        out.add(time, jerk, begin);
        a = a + Twice::product(time, jerk);
        x += ends_x;
        y += ends_y;
        left_x = ends_x ? x->duration : left_x - time;
        left_y = ends_y ? y->duration : left_y - time;
    }
    track = out;
}

PlanResult check(const MotionLimits& limits, const MotionState& from, const Goal& to) {
    const double way = to.position - from.position;
    if (!std::isfinite(way + from.velocity + from.acceleration + to.velocity))
        return PlanResult::not_finite;
    return to.velocity <= limits.side[0].V && -to.velocity <= limits.side[1].V
               ? PlanResult::ok
               : PlanResult::velocity_above_limit;
}

/// The last phase is run back from the end: a state within it is as near to the goal as rounding
/// allows. `duration` is what the sum of the times stands for. Refuses what misses by more than
/// rounding can tell: the numbers are too many decades apart.
PlanResult write(const Track::Phase* phases, const Track& track, const MotionState& from,
                 const Goal& to, double duration, MotionPlan& out) {
    constexpr double most = 1e-6;
    const auto count = static_cast<std::size_t>(track.next - phases);
    MotionState last{0, from.velocity, 0, 0}, back{0, to.velocity, 0, 0};
    if (count > 0) {
        const Track::Phase& phase = phases[count - 1];
        last = {phase.x, phase.position_velocity[1], 0, phase.acceleration_jerk[1]};
        back = MotionState{0, to.velocity, 0, last.jerk}.after(-phase.begin_duration[1]);
    }
    const double missed = ((to.position - from.position) + back.position) - last.position;
    const double size =
        std::max(std::max(std::abs(from.position), std::abs(to.position)), track.path);
    const double fastest = std::max(track.fastest, std::abs(to.velocity));
    if (!(std::abs(missed) <= most * size &&
          std::abs(back.velocity - last.velocity) <= most * fastest &&
          std::abs(duration - track.duration) <= most * duration &&
          std::isfinite(size + fastest * duration)))
        return PlanResult::not_finite;
    out.phases[0] = {0, 0, from};
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(static_cast<void*>(&out.phases.data()[i]), &phases[i],
                    sizeof(MotionPlan::Phase));
    if (count > 1) {
        MotionState& start = out.phases.data()[count - 1].start;
        start.position = to.position + back.position;
        start.velocity = back.velocity;
    }
    out.count = count;
    out.duration = duration;
    out.missed = count > 1 ? missed : 0;
    out.haste = duration > 0 ? MotionPlan::spread / duration : 0;
    out.end = {to.position, to.velocity, 0, 0};
    return PlanResult::ok;
}

/// The problem from where the state is inside the limits, with its direct ramp.
struct Start {
    std::array<Track::Phase, MotionPlan::most_phases + 1> phases;
    Track track;
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
        const double size =
            std::max(std::max(std::abs(from.position), std::abs(to.position)), v * tau);
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
        : track(from, phases.data()),
          state(enter(limits, from, options, track, a_rest)),
          vf(to.velocity),
          way((to.position - from.position) - state.position),
          ahead(
              frame(limits, 1, state, vf, way, missing(limits, from, to, options.tolerance * ulp))),
          ramp(direct(ahead)) {
        const double path = duration() * std::max(std::abs(state.velocity), std::abs(vf));
        const double grain =
            ulp * std::max(std::max(std::abs(from.position), std::abs(to.position)), path);
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

/// In registers: the track is read and written once.
[[gnu::noinline]] void add_to(const Frame& f, const Peak& p, Track& to) {
    Track track = to;
    add(f, p, track);
    to = track;
}

/// The motion of the frame's side becomes the first after it that ends at the goal, and is added.
void add_solved(const Frame& f, Peak& p, Start& start) {
    solve(f, p);
    fit(f, start.a_rest, p);
    if (p.cruise > 0) fit_cruise(f, p);
    add_to(f, p, start.track);
}

void add_soonest(const MotionLimits& limits, Start& start) {
    const double missing = start.ahead.miss;
    if (std::abs(missing) <= start.tolerance) {
        Peak p = start.ramp;
        fit(start.ahead, start.a_rest, p);
        add_to(start.ahead, p, start.track);
    } else if (missing > 0) {
        add_solved(start.ahead, start.ramp, start);
    } else {
        const Frame back = start.back(limits);
        Peak p = mirrored(back, start.ramp);
        add_solved(back, p, start);
    }
}

/// From standstill to standstill at a goal beyond the tolerance.
[[gnu::flatten]] PlanResult plan_from_standstill(const MotionLimits& limits,
                                                 const MotionState& from, const Goal& to,
                                                 MotionPlan& out) {
    const double way = to.position - from.position, sign = std::copysign(1.0, way);
    const Frame f{&limits.side[way < 0], limits.J, limits.per_J, sign, 0, 0, 0, sign * way};
    std::array<Track::Phase, 9> phases;
    Track track(from, phases.data());
    const Peak p = from_standstill(f, f.way);
    add(f, p, track);
    return write(phases.data(), track, from, to, track.duration, out);
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
    Peak up = start.ramp, down = mirrored(back, start.ramp);
    solve_timed(start.ahead, up, duration);
    solve_timed(back, down, duration);
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
          start.track);
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
    if (from.velocity == 0 && from.acceleration == 0 && to.velocity == 0) {
        const double size = std::max(std::abs(from.position), std::abs(to.position));
        const bool moves = std::abs(to.position - from.position) > options.tolerance * ulp * size;
        // Where limits are so far apart that it is lost in them, the general way finds one.
        if (moves && plan_from_standstill(limits, from, to, out) == PlanResult::ok)
            return PlanResult::ok;
    }
    Start start(limits, from, to, options);
    add_soonest(limits, start);
    return write(start.phases.data(), start.track, from, to, start.track.duration, out);
}

PlanResult plan(const MotionLimits& limits, const MotionState& from, const Goal& to,
                double duration, MotionPlan& out, const PlanOptions& options) {
    if (!std::isfinite(duration)) return PlanResult::not_finite;
    if (const PlanResult result = check(limits, from, to); result != PlanResult::ok) return result;
    Start start(limits, from, to, options);
    const bool kept = add_timed(limits, start, duration - start.track.duration);
    const double taken = kept ? duration : std::max(start.track.duration, duration);
    return write(start.phases.data(), start.track, from, to, taken, out);
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

#include "blocks/axis/sync_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lineshaft {

namespace {

/// A timed motion takes the least part of acceleration and jerk, in steps of 4, that is enough.
constexpr double gentlest = 0x1p-12;

/// How far a curve leads beyond both of its ends.
double beyond_ends(const SyncCurve& curve, double end) {
    const Range all = range(curve.y, 0, 1);
    const double begin = curve.y.c[0];
    return std::max(std::min(begin, end) - all.least, all.greatest - std::max(begin, end));
}

}  // namespace

TransitionLimits limits_towards(double direction, const Dynamics& d) {
    const bool forward = direction >= 0;
    return {d.velocity, forward ? d.acceleration : d.deceleration,
            forward ? d.deceleration : d.acceleration, d.jerk};
}

MotionState SyncMotion::guide(const MotionState& first, const MotionState& second) const {
    const double k = coupling.master.ratio();
    if (coupling.second.axis < 0)
        return {k * first.position, k * first.velocity, k * first.acceleration, k * first.jerk};
    const bool adds = coupling.combine == CombineMode::add;
    const double l = adds ? coupling.second.ratio() : -coupling.second.ratio();
    return {k * first.position + l * second.position, k * first.velocity + l * second.velocity,
            k * first.acceleration + l * second.acceleration, k * first.jerk + l * second.jerk};
}

PlanResult SyncMotion::get_onto(const MotionState& slave, const MotionState& onto,
                                const Moment& at) {
    const double towards = onto.velocity != 0 ? onto.velocity : slave.velocity;
    const TransitionGoal goal{coupling.transition, coupling.catch_up != 0, goal_offset};
    Transition tried;
    PlanResult result = plan(limits(towards), slave, onto, goal, tried);
    const bool uneven = dynamics.acceleration != dynamics.deceleration;
    if (result == PlanResult::ok && uneven && tried.runs_against(towards))
        result = plan(limits_towards(towards, symmetric(dynamics)), slave, onto, goal, tried);
    if (result != PlanResult::ok) return result;
    transition = tried;
    start = at;
    stage = Stage::in_transition;
    return result;
}

MotionState SyncMotion::as_foreseen(MotionState onto) const {
    if (!(std::abs(onto.jerk) <= dynamics.jerk)) onto.jerk = 0;
    if (std::abs(onto.acceleration) <= std::min(dynamics.acceleration, dynamics.deceleration))
        return onto;
    return {onto.position, onto.velocity};
}

PlanResult SyncMotion::step_towards(const MotionState& slave, const MotionState& onto,
                                    const Moment& at, double quantum) {
    const double towards = onto.velocity != 0 ? onto.velocity : slave.velocity;
    TransitionLimits kept = limits(towards);
    if (coupling.transition == TransitionMode::acceleration_limited)
        kept.jerk = std::numeric_limits<double>::max();
    const auto next = first_step(kept, quantum, slave, as_foreseen(onto), steps_left);
    if (!next) return PlanResult::limit_not_positive;
    step = {slave.position, slave.velocity, next->acceleration, 0};
    steps_left = next->left;
    in_steps = 1;
    start = at;
    stage = Stage::in_transition;
    return PlanResult::ok;
}

CurvePoint SyncMotion::law_at(double x, const Cam& cam) const {
    const double k = coupling.master.ratio();
    if (law == Law::positioned) return {sync_y + k * (x - sync_x), k, 0, 0};
    return on_axis(cam.at(coupling.master_scaling * x + cam_origin));
}

CurvePoint SyncMotion::on_axis(const CurvePoint& p) const {
    const double M = coupling.master_scaling, S = coupling.slave_scaling;
    return {S * p.y + cam_rise, S * M * p.slope, S * M * M * p.bend, S * M * M * M * p.twist};
}

double SyncMotion::period_from(double master, double towards, const Cam& cam) const {
    constexpr double nearly = 1e-9;
    const double x = coupling.master_scaling * master + cam_origin;
    const double periods = (x - cam.begin()) / cam.length(), nearest = std::round(periods);
    if (std::abs(periods - nearest) > nearly) return std::floor(periods);
    return coupling.master_scaling * towards > 0 ? nearest : nearest - 1;
}

void SyncMotion::meet(const MotionState& master, double position, double repeats) {
    sync_x = position;
    const bool stands = master.velocity == 0;
    const bool ahead = repeats > 0 || position >= master.position;
    direction = stands ? (ahead ? 1 : -1) : (master.velocity < 0 ? -1 : 1);
    if (repeats <= 0) return;
    const double missing = coupling.start_distance - distance(master);
    sync_x += direction * repeats * std::ceil(missing / repeats);
}

bool Meeting::agrees(const Meeting& other) const {
    constexpr double slight = 0x1p-38;
    const auto same = [](double a, double b) {
        return a == b || std::abs(a - b) <= slight * std::max(std::abs(a), std::abs(b));
    };
    return same(time, other.time) && same(state.position, other.state.position) &&
           same(state.velocity, other.state.velocity) &&
           std::abs(state.acceleration - other.state.acceleration) <=
               slight * (1 + std::abs(state.acceleration));
}

Meeting SyncMotion::meet(const Forecast& master) const {
    const double time = master.time_at(sync_x, direction);
    if (!std::isfinite(time)) return {time, {joins.y, 0, 0, 0}};
    return {time, joins.led_by(master.at(time))};
}

TransitionLimits SyncMotion::limits_of(const SyncCurve& on, const Dynamics& d) const {
    const double towards = joins.slope * direction;
    return limits_towards(towards, on.turns() ? symmetric(d) : d);
}

bool SyncMotion::choose_curve(const SyncCurve& tried, const Forecast& master, const Dynamics& d,
                              bool may_turn, CurveFault& fault) {
    if (!may_turn && tried.turns()) return false;
    const CurveFault found = check_ahead(tried, master, limits_of(tried, d));
    if (found != CurveFault::none) fault = found;
    if (found != CurveFault::none) return false;
    way = Way::curve;
    curve = tried;
    return true;
}

/// Each half of its way it is less far beyond the ends, and takes more of the limits: where that is
/// no 16th of the way between them, a shorter one is no better.
bool SyncMotion::choose_later(const MotionState& slave, const Forecast& master, const Dynamics& d,
                              CurveFault& fault) {
    constexpr int most_halvings = 12;
    const double whole = sync_x - master.at(0).position;
    const double enough = 0x1p-4 * std::abs(joins.y - slave.position);
    const auto halved = [&](int times) {
        const double length = std::ldexp(whole, -times);
        return SyncCurve::between(sync_x - length, length, {slave.position, 0, 0, 0}, joins);
    };
    int most = 0;
    while (most < most_halvings && beyond_ends(halved(most), joins.y) > enough) ++most;
    for (const double part : {0.25, 0.5, 1.0}) {
        Dynamics kept = d;
        kept.acceleration *= part;
        kept.deceleration *= part;
        kept.jerk *= part;
        for (int times = most; times > 0; --times)
            if (choose_curve(halved(times), master, kept, true, fault)) return true;
    }
    return false;
}

bool SyncMotion::choose_timed(const MotionState& slave, const Meeting& goal, const Dynamics& d,
                              bool may_turn, CurveFault& fault) {
    if (!std::isfinite(goal.time)) return false;
    const double speed = slave.velocity + goal.state.velocity;
    const double towards = speed != 0 ? speed : goal.state.position - slave.position;
    const bool turns = slave.velocity * goal.state.velocity < 0;
    if (turns && !may_turn) return false;
    Range velocities{towards < 0 ? -d.velocity : 0, towards < 0 ? 0 : d.velocity};
    if (may_turn) velocities = {-d.velocity, d.velocity};
    TransitionLimits kept = limits_towards(towards, may_turn ? symmetric(d) : d);
    const TransitionLimits most = kept;
    CurveFault found = CurveFault::none;
    for (double part = gentlest; part <= 1; part *= 4) {
        kept.acceleration = part * most.acceleration;
        kept.deceleration = part * most.deceleration;
        kept.jerk = part * most.jerk;
        found = timed.begin(slave, goal.state, goal.time, kept, velocities);
        if (found != CurveFault::none) continue;
        way = Way::timed;
        return true;
    }
    fault = found;
    return false;
}

CurveFault SyncMotion::choose(const MotionState& slave, const Forecast& master, const Meeting& goal,
                              const Dynamics& d, const Choice& from) {
    const MotionState leader = master.at(0);
    CurvePoint begin;
    const bool stands = slave.velocity == 0 && slave.acceleration == 0;
    const bool may_begin = from.steady || !from.on_its_way || stands;
    const bool begins =
        may_begin && sync_x != leader.position && start_of_curve(slave, leader, begin);
    const SyncCurve fresh =
        begins ? SyncCurve::between(leader.position, sync_x - leader.position, begin, joins)
               : curve;
    const bool waits = from.steady && !std::isfinite(goal.time);
    CurveFault fault = CurveFault::standing_master;
    for (const bool may_turn : {false, true}) {
        const bool curves = may_turn || !from.steady || !master.goes_against(direction, goal.time);
        meeting = goal;
        stage = Stage::approaching;
        const bool may_wait = stands && begins && coupling.start_distance == 0;
        if (may_turn && may_wait && choose_later(slave, master, d, fault)) return {};
        if (curves && from.kept_curve && choose_curve(curve, master, d, may_turn, fault)) return {};
        if (curves && !from.on_its_way && begins && choose_curve(fresh, master, d, may_turn, fault))
            return {};
        if (from.steady && choose_timed(slave, goal, d, may_turn, fault)) return {};
        if (curves && begins && choose_curve(fresh, master, d, may_turn, fault)) return {};
        if (!waits) continue;
        way = Way::rest;
        return {};
    }
    return fault;
}

CurveFault SyncMotion::approach(const MotionState& slave, const Forecast& master, const Cam& cam,
                                double period, bool steady, const Moment& at) {
    CurvePoint from;
    const MotionState leader = master.at(0);
    joins = law_at(sync_x, cam);
    if (!start_of_curve(slave, leader, from)) return CurveFault::standing_master;
    if (period > 0) {
        const double goal = sync_position(from, joins.slope, sync_x - leader.position, joins.y,
                                          period, coupling.sync_mode);
        sync_y += goal - joins.y;
        cam_rise += goal - joins.y;
        joins.y = goal;
    }
    start = looked = at;
    led = leader;
    return choose(slave, master, meet(master), dynamics, {.steady = steady});
}

CurveFault SyncMotion::approach_anew(const MotionState& slave, const Forecast& master,
                                     bool keeps_curve, bool steady, const Moment& at) {
    start = at;
    return choose(slave, master, meet(master), dynamics, {steady, true, keeps_curve});
}

/// By the least factor that a limit would have to have, alone, or all together.
Shortage SyncMotion::shortage(const MotionState& slave, const Forecast& master, bool steady) const {
    const Meeting goal = meet(master);
    const auto raised = [&](CurveFault limit, double by) {
        Dynamics d = dynamics;
        const bool all = limit == CurveFault::none;
        if (all || limit == CurveFault::velocity) d.velocity *= by;
        if (all || limit == CurveFault::acceleration) d.acceleration *= by, d.deceleration *= by;
        if (all || limit == CurveFault::jerk) d.jerk *= by;
        return d;
    };
    const auto suffices = [&](CurveFault limit, double by) {
        SyncMotion tried = *this;
        return tried.choose(slave, master, goal, raised(limit, by), {.steady = steady}) ==
               CurveFault::none;
    };
    constexpr double greatest = 0x1p20;
    Shortage least;
    double factor = greatest;
    for (const CurveFault limit :
         {CurveFault::none, CurveFault::jerk, CurveFault::acceleration, CurveFault::velocity}) {
        if (!suffices(limit, factor)) continue;
        double low = 1;
        for (int i = 0; i < 50 && factor > low * (1 + 1e-6); ++i) {
            const double middle = std::sqrt(low * factor);
            (suffices(limit, middle) ? factor : low) = middle;
        }
        least = {limit, factor, 1};
        if (limit == CurveFault::none) factor = greatest;
    }
    if (factor == greatest) return least;
    if (least.limit == CurveFault::velocity) least.allowed = dynamics.velocity;
    if (least.limit == CurveFault::acceleration)
        least.allowed = std::min(dynamics.acceleration, dynamics.deceleration);
    if (least.limit == CurveFault::jerk) least.allowed = dynamics.jerk;
    least.needed = least.allowed * factor;
    return least;
}

bool SyncMotion::is_on_law(const MotionState& slave, const MotionState& master,
                           const Cam& cam) const {
    const double wanted = law_at(master.position, cam).led_by(master).acceleration;
    return is_beside_law(slave, master, cam) &&
           std::abs(slave.acceleration - wanted) <= 1e-9 * (1 + std::abs(wanted));
}

bool SyncMotion::is_beside_law(const MotionState& slave, const MotionState& master,
                               const Cam& cam) const {
    const MotionState wanted = law_at(master.position, cam).led_by(master);
    const auto same = [](double a, double b, double size) {
        return std::abs(a - b) <= 1e-12 * (1 + std::abs(a) + std::abs(size));
    };
    return same(slave.position, wanted.position, master.position) &&
           same(slave.velocity, wanted.velocity, master.velocity);
}

}  // namespace lineshaft

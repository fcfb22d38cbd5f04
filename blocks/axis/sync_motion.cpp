#include "blocks/axis/sync_motion.hpp"

#include <cmath>

namespace lineshaft {

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

CurvePoint SyncMotion::law_at(double x, const Cam& cam) const {
    const double k = coupling.master.ratio();
    if (law == Law::positioned) return {sync_y + k * (x - sync_x), k, 0, 0};
    const double M = coupling.master_scaling, S = coupling.slave_scaling;
    const CurvePoint p = cam.at(M * x + cam_origin);
    return {S * p.y + cam_rise, S * M * p.slope, S * M * M * p.bend, S * M * M * M * p.twist};
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

CurveFault SyncMotion::approach(const MotionState& slave, const MotionState& master, const Cam& cam,
                                double period, double interval) {
    CurvePoint from, to = law_at(sync_x, cam);
    const double length = sync_x - master.position;
    if (!start_of_curve(slave, master, from)) return CurveFault::standing_master;
    if (period > 0) {
        const double goal = sync_position(from, to.slope, length, to.y, period, coupling.sync_mode);
        sync_y += goal - to.y;
        cam_rise += goal - to.y;
        to.y = goal;
    }
    const SyncCurve tried = SyncCurve::between(master.position, length, from, to);
    const Range slope = range(tried.y.slope(), 0, 1);
    const bool turns = slope.least < 0 && slope.greatest > 0;
    const double towards = to.slope * direction;
    const CurveFault fault =
        foresee(tried, master,
                turns ? limits_towards(towards, symmetric(dynamics)) : limits(towards), interval);
    if (fault != CurveFault::none) return fault;
    curve = tried;
    stage = Stage::approaching;
    return fault;
}

CurveFault SyncMotion::foresee(const SyncCurve& way, const MotionState& master,
                               const TransitionLimits& kept, double interval) {
    transition.guide = master;
    transition.guide.jerk = 0;
    sure = check(way, master, kept) == CurveFault::none ? 1 : 0;
    return sure != 0 ? CurveFault::none : check_soon(way, master, kept, interval);
}

bool SyncMotion::is_on_law(const MotionState& slave, const MotionState& master,
                           const Cam& cam) const {
    const MotionState wanted = law_at(master.position, cam).led_by(master);
    const auto same = [](double a, double b, double size) {
        return std::abs(a - b) <= 1e-12 * (1 + std::abs(a) + std::abs(size));
    };
    return same(slave.position, wanted.position, master.position) &&
           same(slave.velocity, wanted.velocity, master.velocity) &&
           std::abs(slave.acceleration - wanted.acceleration) <=
               1e-9 * (1 + std::abs(wanted.acceleration));
}

}  // namespace lineshaft

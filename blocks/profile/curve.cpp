#include "blocks/profile/curve.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

namespace {

/// A limit is kept where rounding alone is beyond it.
constexpr double tolerance = 1e-9;

CurveFault fault_of(const MotionState& s, const TransitionLimits& limits) {
    constexpr double more = 1 + tolerance;
    if (!(std::abs(s.velocity) <= limits.velocity * more)) return CurveFault::velocity;
    if (!(s.acceleration <= limits.acceleration * more &&
          s.acceleration >= -limits.deceleration * more))
        return CurveFault::acceleration;
    return std::abs(s.jerk) <= limits.jerk * more ? CurveFault::none : CurveFault::jerk;
}

}  // namespace

MotionState CurvePoint::led_by(const MotionState& master) const {
    const double v = master.velocity, a = master.acceleration;
    return {y, slope * v, (bend * v) * v + slope * a,
            ((twist * v) * v) * v + 3 * (bend * v) * a + slope * master.jerk};
}

SyncCurve SyncCurve::between(double begin, double length, const CurvePoint& from,
                             const CurvePoint& to) {
    const double L = length, LL = L * L, way = to.y - from.y;
    const double v0 = from.slope * L, v1 = to.slope * L;
    const double a0 = 0.5 * from.bend * LL, a1 = 0.5 * to.bend * LL;
    return {begin,
            length,
            {{from.y, v0, a0, 10 * way - 6 * v0 - 4 * v1 - 3 * a0 + a1,
              -15 * way + 8 * v0 + 7 * v1 + 3 * a0 - 2 * a1, 6 * way - 3 * v0 - 3 * v1 - a0 + a1}}};
}

CurvePoint SyncCurve::at(double x) const {
    const double u = share(x), per = 1 / length;
    if (u < 0) return {y.c[0] + y.c[1] * u, y.c[1] * per, 0, 0};
    const auto first = y.slope();
    const auto second = first.slope();
    return {y.at(u), first.at(u) * per, second.at(u) * per * per,
            second.slope().at(u) * per * per * per};
}

bool SyncCurve::turns() const {
    const Range slope = range(y.slope(), 0, 1);
    const double slack = tolerance * slope.size();
    return slope.least < -slack && slope.greatest > slack;
}

CurveFault check(const SyncCurve& curve, const MotionState& now, const TransitionLimits& limits) {
    return check(curve, now, limits, curve.begin + curve.length);
}

CurveFault check_ahead(const SyncCurve& curve, const Forecast& master,
                       const TransitionLimits& limits) {
    constexpr int looks = 32;
    const double end = curve.begin + curve.length;
    const double arrival = master.time_at(end, curve.length);
    for (std::size_t i = 0; i < master.count && master.pieces[i].begin < arrival; ++i) {
        const auto& [begin, start] = master.pieces[i];
        const double duration = std::min(master.end(i), arrival) - begin;
        CurveFault fault = CurveFault::none;
        if (start.jerk == 0)
            fault = check(curve, start, limits,
                          std::isfinite(duration) ? start.after(duration).position : end);
        for (int look = 0; start.jerk != 0 && look <= looks && fault == CurveFault::none; ++look) {
            const MotionState m = start.after(duration * look / looks);
            fault = fault_of(curve.at(m.position).led_by(m), limits);
        }
        if (fault != CurveFault::none) return fault;
    }
    return CurveFault::none;
}

CurveFault check_step(const MotionState& before, const MotionState& now, double time,
                      const TransitionLimits& limits) {
    MotionState state = now;
    state.jerk = (now.acceleration - before.acceleration) / time;
    const CurveFault mean = fault_of(state, limits);
    return mean != CurveFault::none ? mean : fault_of(now, limits);
}

CurveFault check(const SyncCurve& curve, const MotionState& now, const TransitionLimits& limits,
                 double last) {
    const double L = curve.length, here = curve.share(now.position), low = std::max(here, 0.0);
    const double a = now.acceleration, gain = 2 * a * L;
    const double square = now.velocity * now.velocity;
    const bool towards = now.velocity != 0 ? now.velocity * L > 0 : a * L > 0;
    const double turn = gain < 0 && towards ? here - square / gain : 1;
    const double high = towards ? std::min({turn, curve.share(last), 1.0}) : low;
    if (!(low < high)) return CurveFault::none;

    const Polynomial<1> speed{{square - gain * here, gain}};
    const auto first = curve.y.slope();
    const auto second = first.slope();
    const auto scaled = [](auto p, double by) {
        for (double& c : p.c) c *= by;
        return p;
    };
    const auto y1 = scaled(first, 1 / L);
    const auto y2 = scaled(second, 1 / (L * L));
    const auto y3 = scaled(second.slope(), 1 / (L * L * L));

    constexpr double more = 1 + tolerance;
    if (!(range(y1 * y1 * speed, low, high).greatest <= limits.velocity * limits.velocity * more))
        return CurveFault::velocity;
    const Range slave = range(y2 * speed + scaled(y1, a), low, high);
    if (!(slave.greatest <= limits.acceleration * more &&
          slave.least >= -limits.deceleration * more))
        return CurveFault::acceleration;
    const auto y4 = y3 * speed + scaled(y2, 3 * a);
    if (!(range(y4 * y4 * speed, low, high).greatest <= limits.jerk * limits.jerk * more))
        return CurveFault::jerk;
    return CurveFault::none;
}

bool start_of_curve(const MotionState& slave, const MotionState& master, CurvePoint& out) {
    if (slave.velocity == 0 && slave.acceleration == 0) {
        out = {slave.position, 0, 0, 0};
        return true;
    }
    if (master.velocity == 0) return false;
    const double slope = slave.velocity / master.velocity;
    const double bend =
        (slave.acceleration - slope * master.acceleration) / master.velocity / master.velocity;
    out = {slave.position, slope, bend, 0};
    return std::isfinite(slope) && std::isfinite(bend);
}

double sync_position(const CurvePoint& from, double slope, double length, double goal,
                     double modulo, SyncMode mode) {
    const double natural = from.y + 0.5 * (from.slope + slope) * length;
    const double turns = (natural - goal) / modulo;
    switch (mode) {
        case SyncMode::shortest:
            return goal + std::round(turns) * modulo;
        case SyncMode::catch_up:
            return goal + std::ceil(turns) * modulo;
        case SyncMode::slow_down:
            break;
    }
    return goal + std::floor(turns) * modulo;
}

}  // namespace lineshaft

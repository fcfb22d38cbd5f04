#include "blocks/axis/velocity_loop.hpp"

#include <algorithm>
#include <cmath>

#include <sleef.h>

namespace lineshaft {

namespace {

constexpr int most_changes = 16;  // between sliding and sticking in one interval

double sign(double x) {
    return x < 0 ? -1 : 1;
}

/// e^(-a t) cos(w t) and e^(-a t) sin(w t) / w, where w^2 = w0^2 - a^2 may be negative.
struct Oscillation {
    double cosine = 1, sine = 0;

    Oscillation(double a, double w0, double t) {
        const double squared = (w0 - a) * (w0 + a);
        const double w = std::sqrt(std::abs(squared));
        if (squared > 0) {
            const double decay = Sleef_cinz_expd1_u10purec(-a * t);
            cosine = decay * Sleef_cinz_cosd1_u10purec(w * t);
            sine = decay * Sleef_cinz_sind1_u10purec(w * t) / w;
        } else {
            const double slow = Sleef_cinz_expd1_u10purec(-t * w0 * w0 / (a + w));
            const double rest = Sleef_cinz_expm1d1_u10purec(-2 * w * t);
            cosine = slow * (1 + rest / 2);
            sine = w == 0 ? slow * t : -slow * rest / (2 * w);
        }
    }
};

}  // namespace

VelocityLoop::State VelocityLoop::advance(const State& from, double u, double t) const {
    if (kind == Kind::ideal) return {from.position + u * t, u, 0};
    if (coulomb == 0) return slide(from, u, 0, t);
    State now = from;
    for (int change = 0; change < most_changes && t > 0; ++change) {
        if (now.velocity == 0 && std::abs(drive(now, u)) <= coulomb) t = stick(now, u, t);
        if (t <= 0) break;
        const double way = sign(now.velocity != 0 ? now.velocity : drive(now, u));
        const State end = slide(now, u, way * coulomb, t);
        if (!(end.velocity * way < 0)) return end;
        const double zero = time_to_zero(now, u, way * coulomb, t);
        now = slide(now, u, way * coulomb, zero);
        now.velocity = 0;
        t -= zero;
    }
    return now;
}

/// What pushes the motor at rest [u/s^2].
double VelocityLoop::drive(const State& state, double u) const {
    return kind == Kind::first_order ? u / time_constant : state.integral;
}

/// At rest until the drive breaks away; the time that is left then.
double VelocityLoop::stick(State& state, double u, double t) const {
    if (kind == Kind::first_order || u == 0) return 0;
    const double rate = natural_frequency * natural_frequency * u;
    const double breakaway = (sign(u) * coulomb - state.integral) / rate;
    if (!(breakaway < t)) {
        state.integral += rate * t;
        return 0;
    }
    state.integral = sign(u) * coulomb;
    return t - breakaway;
}

VelocityLoop::State VelocityLoop::slide(const State& from, double u, double friction,
                                        double t) const {
    return kind == Kind::first_order ? slide_first_order(from, u, friction, t)
                                     : slide_second_order(from, u, friction, t);
}

VelocityLoop::State VelocityLoop::slide_first_order(const State& from, double u, double friction,
                                                    double t) const {
    const double rate = 1 / time_constant + viscous;
    const double end = (u / time_constant - friction) / rate;
    const double above = from.velocity - end;
    const double lost = above * Sleef_cinz_expm1d1_u10purec(-rate * t);
    return {from.position + end * t - lost / rate, from.velocity + lost, 0};
}

/// y = v - u solves y'' + 2 a y' + w^2 y = 0.
VelocityLoop::State VelocityLoop::slide_second_order(const State& from, double u, double friction,
                                                     double t) const {
    const double w2 = natural_frequency * natural_frequency;
    const double a = damping * natural_frequency + viscous / 2;
    const double y = from.velocity - u;
    const double dy = from.integral - 2 * a * from.velocity - friction;
    const Oscillation f(a, natural_frequency, t);
    const double y_end = y * f.cosine + (dy + a * y) * f.sine;
    const double dy_end = dy * f.cosine - (a * dy + w2 * y) * f.sine;
    const double travelled = u * t - (dy_end - dy + 2 * a * (y_end - y)) / w2;
    const double v_end = u + y_end;
    return {from.position + travelled, v_end, dy_end + 2 * a * v_end + friction};
}

/// By bisection, to the last bit but a few: v changes its sign between 0 and t.
double VelocityLoop::time_to_zero(const State& from, double u, double friction, double t) const {
    double before = 0, after = t;
    for (int i = 0; i < 60; ++i) {
        const double middle = before + (after - before) / 2;
        const bool crossed = slide(from, u, friction, middle).velocity * friction < 0;
        (crossed ? after : before) = middle;
    }
    return after;
}

}  // namespace lineshaft

#include "blocks/axis/transmission.hpp"

#include <algorithm>
#include <cmath>

#include <sleef.h>

namespace lineshaft {

namespace {

/// How many times `scale` fits into `way`, both not below 0; infinitely often when it is 0.
double times(double way, double scale) {
    return way == 0 ? 0 : way / scale;
}

/// (e^-u - e^-w) / (w - u), both not below 0, one of them finite.
double divided_difference(double u, double w) {
    const double apart = std::abs(u - w);
    const double share = apart == 0 ? 1 : -Sleef_cinz_expm1d1_u10purec(-apart) / apart;
    return Sleef_cinz_expd1_u10purec(-std::min(u, w)) * share;
}

}  // namespace

Transmission::State Transmission::advance(const State& state, double motor, double elapsed) const {
    const double driven = std::clamp(state.driven, motor - backlash / 2, motor + backlash / 2);
    const double moved = driven - state.driven;
    const double end = moved == 0 ? state.presliding : moved < 0 ? -1 : 1;
    const double from = state.presliding - end;
    const double u = times(std::abs(moved), presliding_travel);
    const double w = times(elapsed, breakaway_time);
    const double presliding = end + from * Sleef_cinz_expd1_u10purec(-u);
    if (breakaway_time == 0 || std::isinf(w)) return {driven, presliding, presliding};
    const double breakaway = end + (state.breakaway - end) * Sleef_cinz_expd1_u10purec(-w) +
                             from * w * divided_difference(u, w);
    return {driven, presliding, breakaway};
}

double Transmission::table(const State& state) const {
    return state.driven - (windup + breakaway_windup / 2) * state.presliding +
           breakaway_windup / 2 * state.breakaway;
}

}  // namespace lineshaft

#include "blocks/axis/transmission.hpp"

#include <algorithm>
#include <cmath>

#include <sleef.h>

namespace lineshaft {

namespace {

/// z after the way `moved`: it tends to the way's sign over `travel`.
double wound(double z, double moved, double travel) {
    if (moved == 0) return z;
    const double end = moved < 0 ? -1 : 1;
    return travel == 0 ? end
                       : end + (z - end) * Sleef_cinz_expd1_u10purec(-std::abs(moved) / travel);
}

}  // namespace

Transmission::State Transmission::advance(const State& state, double motor) const {
    const double driven = std::clamp(state.driven, motor - backlash / 2, motor + backlash / 2);
    const double moved = driven - state.driven;
    return {driven, wound(state.presliding, moved, presliding_travel),
            wound(state.breakaway, moved, breakaway_travel)};
}

double Transmission::table(const State& state) const {
    return state.driven - (windup + breakaway_windup / 2) * state.presliding +
           breakaway_windup / 2 * state.breakaway;
}

}  // namespace lineshaft

#include <cmath>

#include "blocks/axis/axis.hpp"

namespace lineshaft {

bool adds_turns_to_shortest(const Request& request) {
    return request.period > 0 && request.position >= request.period &&
           request.direction == MoveDirection::shortest_way;
}

double Axis::target_of(const Request& request, const Start& from) const {
    if (!is_absolute(request.command)) return from.origin + request.position;
    if (!keeps_superimposed(request)) return place_of(request, from);
    const double further = added_before + from.taken;
    Start without = from;
    without.state.position -= further;
    return place_of(request, without) + further;
}

/// Where a command to a position leads.
double Axis::place_of(const Request& request, const Start& from) const {
    if (request.period > 0) return modulo_target(request, from, request.period);
    return modulo && request.period == 0 ? modulo_target(request, from, period) : request.position;
}

/// A place that shows the position and that the axis can reach without turning round, and behind
/// it the whole turns that the command asks for. With a period of its own, TwinCAT's, one
/// that begins in motion has none, and keeps its direction.
double Axis::modulo_target(const Request& request, const Start& from, double turn) const {
    constexpr double tolerance = 1e-9;
    const double stop = stopping_position(from.state, dynamics_of(request));
    const double behind = (stop - request.position) / turn;
    const bool is_moving = request.mode == BufferMode::aborting && from.state.velocity != 0;
    const bool adds = request.period > 0 && request.position >= turn && !is_moving;
    const double more = adds ? std::floor(request.position / turn) : 0;
    MoveDirection direction = request.direction;
    if (request.period > 0 && is_moving) direction = MoveDirection::current;
    if (direction == MoveDirection::current)
        direction = from.state.velocity < 0 ? MoveDirection::negative : MoveDirection::positive;
    if (direction == MoveDirection::positive)
        return request.position + turn * (std::ceil(behind - tolerance) + more);
    if (direction == MoveDirection::negative)
        return request.position + turn * (std::floor(behind + tolerance) - more);
    return nearest_to(stop, request.position, turn);
}

/// A position is shown once each turn: the place where it is that is next to another place.
double Axis::nearest_to(double place, double shown_there, double turn) {
    return shown_there + turn * std::floor((place - shown_there) / turn + 0.5);
}

}  // namespace lineshaft

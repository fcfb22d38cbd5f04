#include <algorithm>
#include <cmath>

#include "blocks/axis/axis.hpp"

namespace lineshaft {

namespace {

bool ends_standing(Command command) {
    using enum Command;
    return command == move_absolute || command == move_relative || command == move_additive;
}

/// Of the two velocities the one that the mode wants where they meet.
double wanted_velocity(BufferMode mode, double previous, double next) {
    switch (mode) {
        case BufferMode::blending_low:
            return std::min(previous, next);
        case BufferMode::blending_high:
            return std::max(previous, next);
        case BufferMode::blending_next:
            return next;
        default:
            return previous;
    }
}

}  // namespace

/// What `active` is about to do, seen along its direction.
struct Axis::Junction {
    Start from;
    Dynamics dynamics;
    double direction = 1;
};

/// To the goal with a velocity: within the command's own as long as the way allows.
bool Axis::plan_to_junction(const Junction& junction, double end_velocity, PointMotion& motion,
                            Leg& rest, const Moment& at) const {
    const auto& [from, dynamics, direction] = junction;
    const double end = direction * end_velocity;
    rest = {};
    if (end_velocity > dynamics.velocity) {
        const double cruise = direction * dynamics.velocity;
        const double ahead = ramp_way(cruise, end, dynamics);
        const bool planned =
            motion.begin(from.state, goal - ahead, cruise, dynamics, at) == PlanResult::ok;
        if (planned && !motion.turns(direction)) {
            rest = {1, goal, end, dynamics};
            return true;
        }
    }
    return motion.begin(from.state, goal, end, dynamics, at) == PlanResult::ok &&
           !motion.turns(direction);
}

/// Whether the next command can go on from the goal with the velocity without turning round.
bool Axis::goes_on(const Request& next, const Junction& junction, double velocity_there) const {
    if (next.command == Command::move_velocity) return true;
    Start there = start_of_next();
    const double target = target_of(next, there);
    there.state.velocity = junction.direction * velocity_there;
    const bool continuous = next.command == Command::move_continuous_absolute ||
                            next.command == Command::move_continuous_relative;
    const double end = continuous ? junction.direction * next.end_velocity * factors.velocity : 0;
    PointMotion motion;
    return motion.begin(there.state, target, end, dynamics_of(next), {}) == PlanResult::ok &&
           !motion.turns(junction.direction);
}

/// The direction in which the next command leaves the goal; 0: it is no move.
double Axis::direction_of(const Request& next) const {
    using enum Command;
    if (next.command == move_velocity)
        return next.direction == MoveDirection::negative ? -next.velocity : next.velocity;
    if (!ends_standing(next.command) && next.command != move_continuous_absolute &&
        next.command != move_continuous_relative)
        return 0;
    const Start there = start_of_next();
    return target_of(next, there) - there.origin;
}

/// At the goal, where the next command takes in what is on top.
Axis::Start Axis::start_of_next() const {
    Start there;
    there.state.position = there.origin = goal + added_goal;
    return there;
}

/// The end of `active` is passed with the velocity that the mode of the next command wants, or the
/// greatest below it with which neither of the two has to turn round; 0 if they part there.
void Axis::blend(const Context& context, const Moment& at) {
    const Request& next = front(context).request;
    if (next.mode < BufferMode::blending_low || doing != Doing::moving_to_point) return;
    if (!ends_standing(active.request.command)) return;
    Junction junction{start_again(), dynamics_of(active.request)};
    junction.direction = goal < junction.from.state.position ? -1 : 1;
    if (direction_of(next) * junction.direction <= 0) return;
    const double v2 = next.command == Command::move_velocity
                          ? std::abs(next.velocity) * factors.velocity
                          : dynamics_of(next).velocity;
    const double wanted = wanted_velocity(next.mode, junction.dynamics.velocity, v2);
    PointMotion motion;
    Leg rest;
    const auto is_possible = [&](double v) {
        return plan_to_junction(junction, v, motion, rest, at) && goes_on(next, junction, v) &&
               (!software_limits || can_brake({goal + added_goal, junction.direction * v}));
    };
    if (!is_possible(wanted)) {
        double low = 0, high = wanted;
        for (int i = 0; i < 50; ++i) {
            const double middle = 0.5 * (low + high);
            (is_possible(middle) ? low : high) = middle;
        }
        if (low == 0 || !is_possible(low)) return;
    }
    point_motion = motion;
    leg = rest;
    base = junction.from.state;
    offset = 0;
}

}  // namespace lineshaft

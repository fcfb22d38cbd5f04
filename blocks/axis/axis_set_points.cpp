#include "blocks/axis/axis.hpp"

namespace lineshaft {

MotionState Axis::set_point_of(const Request& request, double here) const {
    const double to = modulo ? nearest_to(here, request.position, period) : request.position;
    return {to, request.velocity, request.acceleration};
}

/// The axis is there at once.
MotionError Axis::plan_set_point(const Request& request, const Moment& at, const Start& from) {
    MotionState next = set_point_of(request, from.state.position);
    if (!may_aim_at(next.position, from)) return MotionError::software_limit;
    take_set_point(next, at);
    return MotionError::none;
}

void Axis::take_set_point(const MotionState& next, const Moment& at) {
    doing = Doing::following_set_points;
    base = next;
    led_at = at.time;
    leg.exists = paused = 0;
    offset = lasting = 0;
    origin = goal = base.position;
}

void Axis::change_set_point(const Context& context, const Moment& at, const Request& request) {
    if (request.is_enabled == 0) return end_set_points(context, at);
    take_set_point(set_point_of(request, base.position + offset), at);
}

/// What waits begins; where nothing does the axis brakes.
void Axis::end_set_points(const Context& context, const Moment& at) {
    const MotionState from = base;
    end(context, active, Progress::done);
    state = AxisState::discrete_motion;
    hold(from, at);
    base = from;
    begin_next(context, at);
}

/// Between two of them the axis goes on as the first one says.
void Axis::go_on_from_set_point(std::int64_t now) {
    base = base.after(seconds(now - led_at));
    led_at = now;
}

}  // namespace lineshaft

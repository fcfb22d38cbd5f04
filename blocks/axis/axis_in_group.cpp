#include "blocks/axis/axis.hpp"

namespace lineshaft {

bool is_taken_in_group(const Request& request) {
    using enum Command;
    const Command command = request.command;
    const bool needs_motion = is_superimposed(command) || is_phasing(command) ||
                              command == gear_out || command == cam_out;
    return command == power_on || command == power_off || command == reset ||
           command == abort_trigger || command == stop ||
           (rules_of(request.rules).leaves_groups && !is_administrative(command) && !needs_motion &&
            request.mode == BufferMode::aborting);
}

MotionError Axis::cannot_follow() const {
    if (state == AxisState::standstill) return MotionError::none;
    const MotionError why = refusal();
    return why == MotionError::wrong_state ? MotionError::axis_moves : why;
}

void Axis::begin_to_follow(const Moment& at) {
    const MotionState from = total();
    safe = {};
    offset = 0;
    clear_added();
    hold(from, at);
    doing = Doing::following_group;
    state = AxisState::synchronized_motion;
    led_at = at.time;
}

void Axis::follow_group(const MotionState& set_point, const Moment& at) {
    base = set_point;
    led_at = at.time;
    if (scan_time != at.time) return;
    if (software_limits && shown.exists != 0) show();
    publish();
}

void Axis::end_following(const Context& context, const Moment& at) {
    if (!follows_group()) return;
    goal = base.position;
    if (base.velocity != 0 || base.acceleration != 0)
        return fail(context, at, MotionError::axis_left_path);
    hold(base, at);
    settle();
}

bool Axis::reset_by_group() {
    if (state != AxisState::error_stop) return true;
    if (doing != Doing::holding) return false;
    leave_error();
    return true;
}

void Axis::switch_power_by_group(const Context& context, const Moment& at, bool on) {
    Request request;
    request.command = on ? Command::power_on : Command::power_off;
    request.enables_positive = request.enables_negative = 1;
    switch_power(context, at, request);
}

MotionError Axis::cannot_run(double from, double to, double least, double greatest) const {
    if (software_limits && !bounds().contain({least, greatest})) return MotionError::software_limit;
    const bool forward = greatest > from || to > least, back = least < from || to < greatest;
    return (forward && !may_go(1)) || (back && !may_go(-1)) ? MotionError::direction_not_enabled
                                                            : MotionError::none;
}

}  // namespace lineshaft

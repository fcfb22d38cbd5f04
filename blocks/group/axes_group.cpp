#include "blocks/group/axes_group.hpp"

namespace lineshaft {

std::span<const Field> AxesGroup::fields() {
    using G = AxesGroup;
    static const Field table[] = {
        parameter("unit", &G::unit, "", "of the first three axes; rotary axes are in deg")
            .one_of(axis_unit_names),
        parameter("default_velocity", &G::default_velocity, "{unit}/s",
                  "along the path, of commands with a velocity below 0")
            .above(0),
        parameter("default_acceleration", &G::default_acceleration, "{unit}/s^2",
                  "along the path, of commands with an acceleration below 0, both ways")
            .above(0),
        parameter("default_jerk", &G::default_jerk, "{unit}/s^3",
                  "along the path, of commands with a jerk below 0")
            .above(0),
        output("state", &G::state, "", "of PLCopen").one_of(group_state_names),
        output("error", &G::error, "", "the group has stopped; MC_GroupReset ends it"),
        output("error_id", &G::error_id, "", "why").one_of(motion_error_names),
        output(
            "distance", &G::distance, "{unit}",
            "way of the first three axes along the path since it began, or, at standstill, of all "
            "of the last one"),
        output("velocity", &G::velocity, "{unit}/s", "of that way: 0 where rotary axes move alone"),
        output("acceleration", &G::acceleration, "{unit}/s^2", "along the path"),
        output("jerk", &G::jerk, "{unit}/s^3", "along the path"),
    };
    return table;
}

Axis* AxesGroup::axis(const Context& context, std::size_t place) const {
    return axes[place] == nowhere ? nullptr : &context.instance<Axis>(axes[place]);
}

void AxesGroup::scan(const Scan& now, const Context& context) {
    const double dt = started != 0 ? seconds(now.time - time) : 0;
    started = 1;
    task = context.task;
    scan_index = now.index;
    time = now.time;
    if (following != 0)
        run(context, dt);
    else
        look_at_axes(context);
    std::int64_t next = inbox.first == nowhere ? nowhere : take_due(context, inbox).first;
    while (next != nowhere) {
        GroupJob& job = context.at<GroupJob>(next);
        next = job.next;
        job.next = nowhere;
        take(context, job);
    }
    if (has_unlaid(context)) lay(context);
}

/// What waits is put into the path at the instant at which there is room, so that the motion does
/// not depend on when scans are.
void AxesGroup::run(const Context& context, double dt) {
    double left = dt;
    while (left > 0 && has_unlaid(context) && !path.finished() && !path.lost) {
        left -= path.advance_to(ring(), left, path.first + 1);
        lay(context);
    }
    const PathMotion motion = path.advance(ring(), left);
    lead(context, motion);
    publish(motion.way);
    if (path.lost) {
        fail(context, MotionError::not_finite);
        path.clear();
        distance = 0;
        return come_to_stand(context);
    }
    look_at_moves(context);
    if (!path.standing()) return;
    if (interrupter.exists()) {
        const bool frees = interrupter.frees != 0;
        end(context, interrupter, Progress::done);
        if (frees) return leave_path(context);
    }
    if (braking != 0 || (path.finished() && queue.first == nowhere)) come_to_stand(context);
}

/// An axis that has left the path brakes by itself, and the others on the path.
void AxesGroup::lead(const Context& context, const PathMotion& motion) {
    if (path.count == 0) return;
    position = motion.position;
    bool has_left = false;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        Axis* const led = axis(context, i);
        if (!led) continue;
        has_left = has_left || !led->follows_group();
        if (!led->follows_group()) continue;
        led->follow_group(
            {position[i] + turned[i], motion.velocity[i], motion.acceleration[i], motion.jerk[i]},
            {time});
    }
    if (has_left) fail(context, MotionError::axis_left_path);
}

/// An error of one is an error of all.
void AxesGroup::look_at_axes(const Context& context) {
    if (resetter.exists()) finish_reset(context);
    if (state == GroupState::disabled || state == GroupState::error_stop) return;
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (const Axis* const led = axis(context, i); led && led->error)
            fail(context, MotionError::axis_left_path);
}

/// Those whose pieces have been run along are done, and the next one is at work.
void AxesGroup::look_at_moves(const Context& context) {
    while (queue.first != nowhere) {
        GroupJob& job = context.at<GroupJob>(queue.first);
        const bool begins = braking == 0 && interrupted == 0 &&
                            (job.is_laid != 0 || job.rows > 0) &&
                            path.first >= static_cast<std::uint64_t>(job.first_piece);
        const bool ends =
            job.is_laid != 0 && path.first >= static_cast<std::uint64_t>(job.end_piece);
        if (begins && !ends && job.progress != Progress::active) tell(job, Progress::active);
        if (!ends) return;
        unlink(context, job, queue);
        tell(job, Progress::done);
    }
}

/// The path is over, or has been given up.
void AxesGroup::come_to_stand(const Context& context) {
    path.clear();
    end_point = position;
    braking = interrupted = 0;
    publish({.position = distance});
    if (holder.exists() && holder.told_end == 0) tell(context, holder, Progress::done);
    holder.told_end = 1;
    if (holder.holds == 0) holder = {};
    if (state == GroupState::moving && queue.first != nowhere) return;
    release(context);
    if (state == GroupState::moving || (state == GroupState::stopping && !holder.exists()))
        state = GroupState::standby;
    if (leaver.exists()) ungroup(context);
}

void AxesGroup::release(const Context& context) {
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (Axis* const led = axis(context, i)) led->end_following(context, {time});
    following = 0;
}

void AxesGroup::publish(const MotionState& way) {
    distance = way.position;
    velocity = way.velocity;
    acceleration = way.acceleration;
    jerk = way.jerk;
}

bool AxesGroup::has_unlaid(const Context& context) const {
    return queue.last != nowhere && context.at<GroupJob>(queue.last).is_laid == 0;
}

bool AxesGroup::is_powered(const Context& context) const {
    bool is_any = false;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const Axis* const seen = axis(context, i);
        if (seen && seen->state == AxisState::disabled) return false;
        is_any = is_any || seen;
    }
    return is_any;
}

PathVector AxesGroup::actual_position(const Context& context) const {
    PathVector out{};
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (const Axis* const seen = axis(context, i)) out[i] = seen->actual().position;
    return out;
}

PathVector AxesGroup::actual_velocity(const Context& context) const {
    PathVector out{};
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (const Axis* const seen = axis(context, i)) out[i] = seen->actual().velocity;
    return out;
}

PathVector AxesGroup::set_position(const Context& context) const {
    PathVector out{};
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (const Axis* const seen = axis(context, i)) out[i] = seen->position;
    return out;
}

}  // namespace lineshaft

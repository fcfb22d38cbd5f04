#include <algorithm>
#include <cassert>
#include <cmath>

#include "blocks/group/axes_group.hpp"

namespace lineshaft {

namespace {

/// What is below 0 is as the moves under way allow.
PathLimit braking_of(const GroupRequest& request) {
    PathLimit limit = no_path_limit;
    if (request.deceleration > 0) limit.acceleration = request.deceleration;
    if (request.jerk > 0) limit.jerk = request.jerk;
    return limit;
}

}  // namespace

void AxesGroup::send(const Context& context, const Scan& now, GroupJob& job) {
    job.task = context.task;
    job.scan = now.index;
    if (job.in == JobPlace::queue) unlink(context, job, job.is_aside != 0 ? aside.queue : queue);
    job.is_aside = 0;
    if (job.in != JobPlace::inbox) link(context, job, inbox, JobPlace::inbox);
}

void AxesGroup::take(const Context& context, GroupJob& job) {
    using enum GroupCommand;
    const GroupRequest& request = job.request;
    if (holder.place == context.place_of(job) && holder.ticket == job.ticket) {
        holder.holds = request.holds;
        if (holder.told_end == 0 || holder.holds != 0) return;
        holder = {};
        state = GroupState::standby;
        return;
    }
    if (is_end(job.progress)) return;
    if (!next_state(request.command, state)) return tell(job, Progress::failed, refusal());
    if (is_move(request.command)) return take_move(context, job);
    const bool brakes =
        request.command == stop || request.command == halt || request.command == interrupt;
    if (brakes && (request.deceleration == 0 || request.jerk == 0))
        return tell(job, Progress::failed, MotionError::limit_not_positive);
    if (request.command == stop || request.command == halt) return hold(context, job);
    if (request.command == interrupt) return begin_interrupt(context, job);
    if (request.command == reset) return begin_reset(context, job);
    if (request.command == GroupCommand::ungroup) return begin_to_ungroup(context, job);
    const MotionError why = administer(context, job);
    tell(job, why == MotionError::none ? Progress::done : Progress::failed, why);
}

/// One that aborts begins where the group then stands on the path of before.
void AxesGroup::take_move(const Context& context, GroupJob& job) {
    const PathFrame of = frame_of(job.request.coordinates);
    if (const MotionError why = check(context, job.request, of); why != MotionError::none)
        return tell(job, Progress::failed, why);
    if (job.request.mode == BufferMode::aborting && following != 0) {
        abort_all(context, Progress::aborted);
        brake();
    }
    job.frame = of;
    job.first_piece = job.end_piece = job.rows = job.is_laid = 0;
    link(context, job, queue, JobPlace::queue);
    tell(job, Progress::waiting);
    state = GroupState::moving;
}

MotionError AxesGroup::administer(const Context& context, GroupJob& job) {
    switch (job.request.command) {
        case GroupCommand::add_axis:
            return add_axis(context, job.request);
        case GroupCommand::remove_axis:
            return remove_axis(context, job.request);
        case GroupCommand::enable:
            return enable();
        case GroupCommand::disable:
            disable(context);
            return MotionError::none;
        case GroupCommand::go_on:
            return go_on(context);
        case GroupCommand::set_transform:
            set_transform(job.request);
            return MotionError::none;
        case GroupCommand::power:
            switch_power(context, job.request);
            return MotionError::none;
        case GroupCommand::set_override:
            return set_override(context, job);
        case GroupCommand::none:
        case GroupCommand::ungroup:
        case GroupCommand::reset:
        case GroupCommand::stop:
        case GroupCommand::halt:
        case GroupCommand::interrupt:
        case GroupCommand::move_linear_absolute:
        case GroupCommand::move_linear_relative:
        case GroupCommand::move_circular_absolute:
        case GroupCommand::move_circular_relative:
        case GroupCommand::move_direct_absolute:
        case GroupCommand::move_direct_relative:
        case GroupCommand::move_path:
            break;
    }
    assert(false);  // another function has it
    return MotionError::wrong_state;
}

MotionError AxesGroup::add_axis(const Context& context, const GroupRequest& request) {
    if (request.place < 1 || request.place > static_cast<std::int64_t>(most_path_axes))
        return MotionError::out_of_range;
    if (following != 0) return MotionError::wrong_state;
    const auto place = static_cast<std::size_t>(request.place - 1);
    Axis& added = context.instance<Axis>(request.axis);
    if (axes[place] == request.axis) return MotionError::none;
    if (axes[place] != nowhere || added.group != nowhere) return MotionError::already_in_group;
    if (added.unit != (place < path_space ? unit : AxisUnit::deg))
        return MotionError::unit_of_group;
    if (added.started == 0 || added.task != task) return MotionError::task_of_group;
    forget_path_aside(context);
    axes[place] = request.axis;
    added.group = context.place_of(*this);
    if (has_power != 0) added.switch_power_by_group(context, {time}, true);
    return MotionError::none;
}

MotionError AxesGroup::remove_axis(const Context& context, const GroupRequest& request) {
    if (request.place < 1 || request.place > static_cast<std::int64_t>(most_path_axes))
        return MotionError::out_of_range;
    if (following != 0) return MotionError::wrong_state;
    const auto place = static_cast<std::size_t>(request.place - 1);
    forget_path_aside(context);
    if (Axis* const removed = axis(context, place)) removed->group = nowhere;
    axes[place] = nowhere;
    if (axis_count() == 0 && state == GroupState::standby) state = GroupState::disabled;
    return MotionError::none;
}

std::size_t AxesGroup::axis_count() const {
    return axes.size() - static_cast<std::size_t>(std::ranges::count(axes, nowhere));
}

MotionError AxesGroup::enable() {
    if (state != GroupState::disabled) return MotionError::none;
    if (leaver.exists()) return MotionError::wrong_state;
    if (axis_count() < 2) return MotionError::too_few_axes;
    state = GroupState::standby;
    return MotionError::none;
}

/// In any state; what is in motion brakes on its path.
void AxesGroup::disable(const Context& context) {
    abort_all(context, Progress::aborted);
    forget_path_aside(context);
    end(context, resetter, Progress::aborted);
    if (following != 0) brake();
    error = false;
    error_id = MotionError::none;
    state = GroupState::disabled;
}

MotionError AxesGroup::set_override(const Context& context, GroupJob& job) {
    const GroupRequest& request = job.request;
    if (!(request.velocity_factor >= 0) || request.acceleration_factor != 1 ||
        request.jerk_factor != 1)
        return MotionError::out_of_range;
    end(context, overriding, Progress::aborted);
    overriding = {context.place_of(job), job.ticket, request.command};
    path.set_override(request.velocity_factor);
    return MotionError::none;
}

/// Without it an axis leaves the path that it is on.
void AxesGroup::switch_power(const Context& context, const GroupRequest& request) {
    has_power = request.is_enabled;
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (Axis* const led = axis(context, i))
            led->switch_power_by_group(context, {time}, has_power != 0);
}

/// Moves that have been taken up keep the one of before.
void AxesGroup::set_transform(const GroupRequest& request) {
    const PathVector& x = request.transform;
    frame = PathFrame::of({x[0], x[1], x[2]}, {x[3], x[4], x[5]});
}

/// The moves go on waiting.
void AxesGroup::begin_interrupt(const Context& context, GroupJob& job) {
    if (braking != 0 || interrupted != 0)
        return tell(job, Progress::failed, MotionError::wrong_state);
    path.halt(braking_of(job.request));
    interrupted = 1;
    if (queue.first != nowhere) tell(context.at<GroupJob>(queue.first), Progress::waiting);
    interrupter = {context.place_of(job), job.ticket, job.request.command, 0, job.request.frees};
    tell(job, Progress::active);
}

MotionError AxesGroup::go_on(const Context& context) {
    if (interrupted == 0) return return_to_path(context);
    end(context, interrupter, Progress::aborted);
    interrupted = 0;
    path.resume();
    return MotionError::none;
}

/// Whether the moves of a queue are aside.
static void mark(const Context& context, const JobList& queue, bool aside) {
    for (std::int64_t place = queue.first; place != nowhere;) {
        GroupJob& job = context.at<GroupJob>(place);
        job.is_aside = aside ? 1 : 0;
        place = job.next;
    }
}

/// It stands: path and moves are put aside, and other moves may be made.
void AxesGroup::leave_path(const Context& context) {
    forget_path_aside(context);
    aside = {1, queue, path, position, end_point};
    mark(context, queue, true);
    queue = {};
    ring_in_use = 1 - ring_in_use;
    path.clear();
    end_point = position;
    interrupted = 0;
    publish({.position = distance});
    release(context);
    state = GroupState::standby;
}

/// From where it was left, as exactly as positions are that have been read and moved to.
MotionError AxesGroup::return_to_path(const Context& context) {
    constexpr double nearly = 1e-6;
    if (aside.exists == 0 || state != GroupState::standby) return MotionError::wrong_state;
    find_axes(context);
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (!(std::abs(position[i] - aside.position[i]) <=
              nearly * (1 + std::abs(aside.position[i]))))
            return MotionError::not_where_interrupted;
    if (const MotionError why = begin_to_follow(context); why != MotionError::none) return why;
    const double factor = path.override;
    queue = aside.queue;
    path = aside.path;
    end_point = aside.end_point;
    mark(context, queue, false);
    aside = {};
    ring_in_use = 1 - ring_in_use;
    path.set_override(factor);
    path.resume();
    state = GroupState::moving;
    return MotionError::none;
}

void AxesGroup::forget_path_aside(const Context& context) {
    while (aside.queue.first != nowhere) {
        GroupJob& job = context.at<GroupJob>(aside.queue.first);
        unlink(context, job, aside.queue);
        job.is_aside = 0;
        tell(job, Progress::aborted);
    }
    aside = {};
}

/// MC_GroupStop and MC_GroupHalt.
void AxesGroup::hold(const Context& context, GroupJob& job) {
    const bool stops = job.request.command == GroupCommand::stop;
    abort_all(context, Progress::aborted);
    holder = {context.place_of(job), job.ticket, job.request.command,
              stops ? job.request.holds : 0};
    state = *next_state(job.request.command, state);
    tell(job, Progress::active);
    if (following != 0)
        brake(braking_of(job.request));
    else
        come_to_stand(context);
}

void AxesGroup::begin_reset(const Context& context, GroupJob& job) {
    if (state != GroupState::error_stop) return tell(job, Progress::done);
    end(context, resetter, Progress::aborted);
    resetter = {context.place_of(job), job.ticket, job.request.command};
    tell(job, Progress::active);
    if (following == 0) finish_reset(context);
}

/// As soon as all stand.
void AxesGroup::finish_reset(const Context& context) {
    bool all_stand = true;
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (Axis* const led = axis(context, i)) all_stand = led->reset_by_group() && all_stand;
    if (!all_stand) return;
    error = false;
    error_id = MotionError::none;
    state = GroupState::standby;
    end(context, resetter, Progress::done);
}

void AxesGroup::begin_to_ungroup(const Context& context, GroupJob& job) {
    disable(context);
    end(context, leaver, Progress::aborted);
    leaver = {context.place_of(job), job.ticket, job.request.command};
    tell(job, Progress::active);
    if (following == 0) ungroup(context);
}

void AxesGroup::ungroup(const Context& context) {
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (Axis* const removed = axis(context, i)) removed->group = nowhere;
    axes.fill(nowhere);
    disable(context);
    end(context, leaver, Progress::done);
}

void AxesGroup::brake(const PathLimit& limit) {
    path.halt(limit);
    braking = 1;
}

void AxesGroup::fail(const Context& context, MotionError why) {
    if (state == GroupState::error_stop) return;
    abort_all(context, Progress::failed, why);
    if (following != 0) brake();
    error = true;
    error_id = why;
    state = GroupState::error_stop;
}

void AxesGroup::abort_all(const Context& context, Progress how, MotionError why) {
    while (queue.first != nowhere) {
        GroupJob& job = context.at<GroupJob>(queue.first);
        unlink(context, job, queue);
        tell(job, how, why);
    }
    end(context, holder, how, why);
    end(context, interrupter, how, why);
    interrupted = 0;
}

void AxesGroup::end(const Context& context, Holder& ended, Progress how, MotionError why) {
    if (ended.exists() && ended.told_end == 0) tell(context, ended, how, why);
    ended = {};
}

/// Nothing to a command that has been started anew.
void AxesGroup::tell(const Context& context, const Holder& told, Progress how,
                     MotionError why) const {
    GroupJob& job = context.at<GroupJob>(told.place);
    if (job.ticket == told.ticket) tell(job, how, why);
}

void AxesGroup::tell(GroupJob& job, Progress how, MotionError why) const {
    job.tell(how, why, task, scan_index);
}

MotionError AxesGroup::refusal() const {
    switch (state) {
        case GroupState::disabled:
            return MotionError::group_disabled;
        case GroupState::stopping:
            return MotionError::group_stopping;
        case GroupState::error_stop:
            return MotionError::group_in_error;
        default:
            return MotionError::wrong_state;
    }
}

}  // namespace lineshaft

#include "blocks/axis/axis.hpp"

namespace lineshaft {

void Axis::send(const Context& context, const Scan& now, Job& job) {
    if (job.in == JobPlace::queue) {
        unlink(context, job, queue);
        withdrawn = 1;
    }
    job.task = context.task;
    job.scan = now.index;
    if (job.in != JobPlace::inbox) link(context, job, inbox, JobPlace::inbox);
}

Job& Axis::front(const Context& context) const {
    return context.at<Job>(queue.first);
}

void Axis::take_up(const Context& context, const Scan& now) {
    std::int64_t next = take_due(context, inbox).first;
    while (next != nowhere) {
        Job& job = context.at<Job>(next);
        next = job.next;
        job.next = nowhere;
        take(context, {now.time}, job);
    }
}

void Axis::take(const Context& context, const Moment& at, Job& job) {
    const std::int64_t place = context.place_of(job);
    for (Running* running : {&active, &added, &phased})
        if (running->place == place && running->ticket == job.ticket)
            return change(context, at, *running, job);
    if (is_end(job.progress)) return;
    const Request& request = job.request;
    if (follows_group() && !is_taken_in_group(request))
        return tell(job, Progress::failed, MotionError::axis_in_group);
    if (state == AxisState::stopping && request.command == Command::stop &&
        (active.place == place || takes_over_stop(request)))
        return stop_again(context, at, job);
    if (rules_of(request.rules).ends_endless && is_endless())
        job.request.mode = BufferMode::aborting;
    const bool waits =
        request.mode != BufferMode::aborting && is_occupied() && can_be_followed(state);
    const bool is_of_slave = is_phasing(request.command) || request.command == Command::gear_out ||
                             request.command == Command::cam_out;
    if (doing == Doing::following_set_points && is_of_slave)
        return tell(job, Progress::failed, MotionError::wrong_state);
    if (powered_in == scan_index && !next_state(request.command, AxisState::disabled))
        return tell(job, Progress::failed, MotionError::axis_disabled);
    if ((!waits || is_phasing(request.command)) && !next_state(request.command, state))
        return tell(job, Progress::failed, refusal());
    if (request.command == Command::reset && state == AxisState::error_stop &&
        doing != Doing::holding)
        return wait(context, at, job);
    if (is_administrative(request.command) && !waits) return carry_out(context, at, job);
    if (is_superimposed(request.command)) return begin_added(context, at, job);
    if (is_phasing(request.command)) {
        if (request.mode == BufferMode::aborting || !phased.exists())
            return begin_phasing(context, job);
        link(context, job, inbox, JobPlace::inbox);
        return tell(job, Progress::waiting);
    }
    if (waits) return wait(context, at, job);
    begin(context, follows_group() ? Moment{led_at} : at, job);
}

/// Something is under way that ends by itself or by another command. What goes by the way of a
/// motion beneath, and has none, waits for that.
bool Axis::is_occupied() const {
    return active.exists() || (added.exists() && !goes_by_way());
}

/// Where both are ranked, as those of Siemens. One that stands has done its work.
bool Axis::takes_over_stop(const Request& request) const {
    const Request& held = active.request;
    const bool is_ranked = held.command == Command::stop && held.significance > 0;
    return active.exists() && is_ranked && request.significance > 0 &&
           (active.told_end != 0 || request.significance >= held.significance);
}

/// An administrative command, whatever the axis is doing.
void Axis::carry_out(const Context& context, const Moment& at, Job& job) {
    safe = {};
    const MotionError why = administer(context, at, job.request);
    if (job.request.command == Command::set_override && why == MotionError::none) {
        end(context, overriding, Progress::aborted);
        overriding = {context.place_of(job), job.ticket, job.request, 0};
    }
    tell(job, why == MotionError::none ? Progress::done : Progress::failed, why);
}

/// Continuous update, or the end of MC_Stop's Execute.
void Axis::change(const Context& context, const Moment& at, Running& running, Job& job) {
    const Request before = running.request;
    if (job.request.command == Command::halt && before.command != Command::halt)
        return let_go(context, at, job);
    running.request = job.request;
    if (job.request.command == Command::stop) {
        if (running.told_end == 0 || job.request.holds != 0) return;
        return end_hold(context, at);
    }
    if (job.request.command == Command::motion_in_position)
        return change_set_point(context, at, job.request);
    if (&running == &phased) return begin_phasing(context, context.at<Job>(running.place));
    if (&running == &added) return change_added(context, at, before);
    if (may_exchange_cam(job.request)) {
        if (!exchange_cam(context, job.request)) running.request = before;
        return;
    }
    if (plan_any(context, job.request, at, start_again()) != MotionError::none) {
        running.request = before;
        return;
    }
    if (queue.first != nowhere) {
        look_ahead(context);
        blend(context, at);
    }
    tell(context, running, keeps_gear(context) ? Progress::reached : begun());
}

/// The motion under way is to end as by MC_Halt. Where that fails it goes on, and nobody has it.
void Axis::let_go(const Context& context, const Moment& at, Job& job) {
    Running before = active;
    before.told_end = 1;
    active = {};
    begin(context, at, job);
    if (!active.exists()) active = before;
}

/// StartSync: a slave may leave to meet its master at once, or for its cam.
Progress Axis::begun() const {
    const bool ramps_in =
        sync.law == SyncMotion::Law::cammed && sync.stage == SyncMotion::Stage::in_transition;
    const bool leaves = doing == Doing::following_axes &&
                        (sync.stage == SyncMotion::Stage::approaching || ramps_in);
    return leaves ? Progress::approaching : Progress::active;
}

/// Whether what is at work never ends by itself.
bool Axis::is_endless() const {
    return state == AxisState::continuous_motion && !is_continuous(active.request.command);
}

void Axis::wait(const Context& context, const Moment& at, Job& job) {
    if (rules_of(job.request.rules).one_waits && queue.first != nowhere)
        return tell(job, Progress::failed, MotionError::buffer_full);
    if (!may_blend(context, job.request))
        return tell(job, Progress::failed, MotionError::no_blending);
    if (!may_wait(context, job.request))
        return tell(job, Progress::failed, MotionError::software_limit);
    link(context, job, queue, JobPlace::queue);
    tell(job, Progress::waiting);
    if (job.request.command == Command::reset) return;
    const bool changes = look_ahead(context, job);
    if (&front(context) != &job) {
        if (changes) blend(context, at);
        return;
    }
    const bool holds =
        (state == AxisState::continuous_motion && doing == Doing::holding && !is_held()) ||
        (doing == Doing::following_axes && sync.holds());
    if (holds) return begin_next(context, at);
    blend(context, at);
}

/// From the state in which the axis is at that moment.
void Axis::begin(const Context& context, const Moment& at, Job& job, const Stretch* along) {
    const Request request = job.request;
    if (is_administrative(request.command)) return carry_out(context, at, job);
    const bool aborts = request.mode == BufferMode::aborting;
    const bool drops_added = !keeps_added(request);
    const bool stands = base.velocity == 0 && base.acceleration == 0;
    const auto next =
        next_state(request.command, stands && !aborts ? AxisState::standstill : state);
    if (!next) return tell(job, Progress::failed, refusal());
    const Start from = start_of(request, drops_added);
    if (along) {
        go_along(*along, job, from);
    } else if (const MotionError why = plan_any(context, request, at, from);
               why != MotionError::none) {
        return tell(job, Progress::failed, why);
    }
    take_in(from.taken);
    if (drops_added) {
        clear_added();
        end(context, added, Progress::aborted);
    }
    if (aborts) abort_beneath(context, Progress::aborted);
    end(context, active, Progress::aborted);
    active = {context.place_of(job), job.ticket, request, 0};
    ++commands;
    wants_calls = rules_of(request.rules).wants_calls;
    stopped = request.command == Command::stop || request.command == Command::halt ? 1 : 0;
    const bool was_overridden = is_overridden();
    state = *next;
    const bool counts = is_absolute(request.command) && !keeps_superimposed(request);
    added_counted = added.exists() && counts && !aborts ? 1 : 0;
    if (is_overridden() != was_overridden) replan_added(context, at);
    tell(job, begun());
}

/// The first of the queue that can be begun.
void Axis::begin_next(const Context& context, const Moment& at, const Stretch* rest) {
    bool as_foreseen = true;
    while (queue.first != nowhere) {
        Job& job = front(context);
        unlink(context, job, queue);
        const bool along = rest && as_foreseen && leads_along(*rest, job);
        begin(context, at, job, along ? rest : nullptr);
        as_foreseen = as_foreseen && !is_end(job.progress) && goal == job.ahead.goal;
        if (is_end(job.progress)) continue;
        if (along || queue.first == nowhere) return;
        if (!as_foreseen) look_ahead(context);
        return blend(context, at);
    }
    if (!active.exists() && state == AxisState::discrete_motion) come_to_stand(at);
    settle();
}

/// What waits is aborted, and what is at work, or else it fails.
void Axis::abort_all(const Context& context, MotionError why) {
    const Progress how = why == MotionError::none ? Progress::aborted : Progress::failed;
    abort_beneath(context, how, why);
    end(context, added, how, why);
}

/// The same, but for what is on top.
void Axis::abort_beneath(const Context& context, Progress how, MotionError why) {
    end(context, active, how, why);
    end(context, phased, how, why);
    end_waiting(context, how, why);
}

void Axis::end_waiting(const Context& context, Progress how, MotionError why) {
    while (queue.first != nowhere) {
        Job& job = front(context);
        unlink(context, job, queue);
        tell(job, how, why);
    }
}

void Axis::end(const Context& context, Running& running, Progress how, MotionError why) {
    if (running.exists() && running.told_end == 0) tell(context, running, how, why);
    running = {};
}

/// Nothing to a command that has been started anew.
void Axis::tell(const Context& context, const Running& running, Progress how,
                MotionError why) const {
    if (!running.exists()) return;
    Job& job = context.at<Job>(running.place);
    if (job.ticket != running.ticket) return;
    if (&running == &added || &running == &phased) job.told_value = running.covered;
    tell(job, how, why);
}

void Axis::tell(Job& job, Progress how, MotionError why) const {
    job.tell(how, why, task, scan_index);
    job.shortage = shortage;
}

MotionError Axis::refusal() const {
    switch (state) {
        case AxisState::disabled:
            return MotionError::axis_disabled;
        case AxisState::stopping:
            return MotionError::axis_stopping;
        case AxisState::homing:
            return MotionError::axis_homing;
        case AxisState::error_stop:
            return MotionError::axis_in_error;
        default:
            return MotionError::wrong_state;
    }
}

}  // namespace lineshaft

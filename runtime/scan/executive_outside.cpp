#include <algorithm>

#include <fmt/format.h>

#include "runtime/scan/executive.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

void Executive::advance_devices() {
    for (const DeviceCall& device : machine_.devices) advance_device(device);
}

/// A device runs on its own outputs, forced or not.
void Executive::advance_device(const DeviceCall& device) {
    if (forces_.active()) forces_.lift_outputs(device.block);
    device.calls.advance(device.block, now_, device.sink);
    report_warnings(device, -1);
    if (forces_.active()) forces_.impose_outputs(device.block);
}

void Executive::publish_device(const DeviceCall& device) {
    if (forces_.active()) forces_.lift_outputs(device.block);
    device.calls.publish(device.block, now_);
    device.calls.advance(device.block, now_, device.sink);
    state(device.task).may_err = true;
    report_warnings(device, device.task);
    if (forces_.active()) forces_.impose_outputs(device.block);
}

std::int64_t Executive::next_event_time(const DeviceCall& device) {
    if (!forces_.active()) return device.calls.next_event_time(device.block);
    forces_.lift_outputs(device.block);
    const std::int64_t next = device.calls.next_event_time(device.block);
    forces_.impose_outputs(device.block);
    return next;
}

void Executive::act_from_outside() {
    if (forces_.next_time() <= now_) forces_.update(now_, events_);
    play();
    const auto& stimuli = machine_.stimuli;
    while (next_stimulus_ < stimuli.size() && stimuli[next_stimulus_].at <= now_)
        set(stimuli[next_stimulus_++], -1);
    for (const Stimulus& value : mail_) set(value, -1);
    mail_.clear();
    while (next_look_ < machine_.looks.size() && machine_.looks[next_look_] <= now_) ++next_look_;
    look_ahead();
}

void Executive::play() {
    for (Replay& replay : machine_.replays)
        if (const auto value = replay.play(now_))
            store(replay.type(), forces_.own(replay.target()), *value);
}

void Executive::stimulate(int index) {
    const Task& task = this->task(index);
    State& state = this->state(index);
    for (; state.next_stimulus < task.stimuli.size() &&
           task.stimuli[state.next_stimulus].at == state.scan.index;
         ++state.next_stimulus)
        set(task.stimuli[state.next_stimulus], index);
    if (state.next_cost < task.costs.size() &&
        task.costs[state.next_cost].scan == state.scan.index) {
        state.cost = task.costs[state.next_cost++].cost;
        if (events_)
            tell(EventKind::stimulus, index,
                 fmt::format("this scan takes {}", format_time(state.cost)));
    }
    look_ahead(index);
}

void Executive::set(const Stimulus& stimulus, int index) {
    store(stimulus.type, forces_.own(stimulus.target), stimulus.value);
    if (events_) tell(EventKind::stimulus, index, stimulus.text);
}

void Executive::look_ahead(int index) {
    const Task& task = this->task(index);
    State& state = this->state(index);
    state.outside = never;
    if (state.next_stimulus < task.stimuli.size())
        state.outside = task.stimuli[state.next_stimulus].at;
    if (state.next_cost < task.costs.size())
        state.outside = std::min(state.outside, task.costs[state.next_cost].scan);
}

void Executive::detect_edges() {
    for (std::size_t i = 0; i < trigger_levels_.size() && !stopped_; ++i) {
        const Trigger& trigger = machine_.triggers[i];
        if (!rising_edge(*trigger.signal, trigger_levels_[i])) continue;
        State& state = this->state(trigger.task);
        if (state.pending && state.released < now_) {
            due_again(trigger.task);
            continue;
        }
        make_pending(trigger.task);
        state.released = now_;
    }
}

}  // namespace lineshaft

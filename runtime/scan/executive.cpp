#include "runtime/scan/executive.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lineshaft {

namespace {

constexpr std::int64_t most_starts_at_once = 1000;

template <class T>
T read(const std::byte* slot) {
    T value;
    std::memcpy(&value, slot, sizeof value);
    return value;
}

/// The end of time when the sum lies beyond it.
std::int64_t later(std::int64_t time, std::int64_t by) {
    return by > 0 && time > never - by ? never : time + by;
}

template <std::size_t size>
const Copy* copy(const Copy* wire, std::uint32_t count) {
    for (; count > 0; --count, ++wire) std::memcpy(wire->target, wire->source, size);
    return wire;
}

template <class T>
void store(const ConvertedCopy& wire, T value) {
    std::memcpy(wire.target, &value, sizeof value);
}

void convert(const ConvertedCopy& wire) {
    using Kind = ConvertedCopy::Kind;
    const auto widened = [&] { return static_cast<double>(read<std::int64_t>(wire.source)); };
    const auto scaled = [&](double value) { return value * wire.factor / wire.divisor; };
    switch (wire.kind) {
        case Kind::negated:
            return store(wire, !read<bool>(wire.source));
        case Kind::widened:
            return store(wire, widened());
        case Kind::scaled:
            return store(wire, scaled(read<double>(wire.source)));
        case Kind::widened_and_scaled:
            return store(wire, scaled(widened()));
    }
}

}  // namespace

std::string format_time(std::int64_t nanoseconds) {
    constexpr std::int64_t second = 1'000'000'000;
    std::string text = fmt::format("{}", nanoseconds / second);
    if (nanoseconds % second != 0) text += fmt::format(".{:09}", nanoseconds % second);
    if (text.find('.') != std::string::npos) text.erase(text.find_last_not_of('0') + 1);
    return text + " s";
}

Executive::Executive(Machine& machine) : machine_(machine) {
    for (const BlockSeed& seed : machine.block_seeds) sow(seed, machine.seed);
    for (const Task& task : machine.tasks) {
        states_.push_back({.jitter = Random(machine.seed, task.name + ".jitter"),
                           .cost_jitter = Random(machine.seed, task.name + ".cost"),
                           .due = task.on_event ? never : task.offset,
                           .scan = {}});
    }
    for (const Trigger& trigger : machine.triggers) trigger_levels_.push_back(*trigger.signal);
    running_.reserve(machine.tasks.size());
    result_.scans.resize(machine.tasks.size());
}

RunResult Executive::run(const std::vector<Observer*>& observers,
                         const std::atomic<bool>* interrupt,
                         const std::function<void(std::int64_t)>& progress) {
    observers_ = &observers;
    std::int64_t next = next_event();
    for (std::uint32_t instants = 0; next <= machine_.duration; ++instants) {
        advance(next);
        instant();
        next = next_event();
        const bool reached = machine_.until && read<bool>(machine_.until->slot);
        const std::int64_t last =
            stopped_ || reached ? now_ : std::min(next - 1, machine_.duration);
        for (Observer* observer : observers) observer->settled(now_, last + 1);
        result_.time = now_;
        if (stopped_ || reached) return result_;
        if (instants % 4096 != 0) continue;
        if (progress) progress(now_);
        if (interrupt && *interrupt) {
            stop(Outcome::interrupted, "interrupted at " + format_time(now_));
            return result_;
        }
    }
    advance(machine_.duration);
    advance_devices();
    result_.time = now_;
    if (machine_.until)
        stop(Outcome::limit, fmt::format("'{}' did not become true within {}", machine_.until->name,
                                         format_time(machine_.duration)));
    return result_;
}

std::int64_t Executive::next_event() const {
    std::int64_t next = never;
    for (const State& state : states_) next = std::min(next, state.due);
    if (next_stimulus_ < machine_.stimuli.size())
        next = std::min(next, machine_.stimuli[next_stimulus_].at);
    if (next_look_ < machine_.looks.size()) next = std::min(next, machine_.looks[next_look_]);
    for (const DeviceCall& device : machine_.devices)
        next = std::min(next, device.calls.next_event_time(device.block));
    if (!running_.empty())
        next = std::min(next,
                        later(now_, states_[static_cast<std::size_t>(running_.back())].remaining));
    return next;
}

void Executive::advance(std::int64_t time) {
    if (!running_.empty())
        states_[static_cast<std::size_t>(running_.back())].remaining -= time - now_;
    now_ = time;
}

void Executive::instant() {
    advance_devices();
    stimulate();
    detect_edges();
    finish_top();
    if (!stopped_) release();
    if (!stopped_) start_pending();
}

void Executive::advance_devices() {
    for (const DeviceCall& device : machine_.devices)
        device.calls.advance(device.block, now_, device.sink);
    while (next_look_ < machine_.looks.size() && machine_.looks[next_look_] <= now_) ++next_look_;
}

void Executive::detect_edges() {
    for (std::size_t i = 0; i < trigger_levels_.size() && !stopped_; ++i) {
        const Trigger& trigger = machine_.triggers[i];
        const bool risen = *trigger.signal && !trigger_levels_[i];
        trigger_levels_[i] = *trigger.signal;
        if (!risen) continue;
        State& state = states_[static_cast<std::size_t>(trigger.task)];
        if (state.pending && state.released < now_)
            return stop(Outcome::overrun,
                        fmt::format("event task '{}' overran: its event comes again at {}, before "
                                    "the scan for that of {} could begin",
                                    machine_.tasks[static_cast<std::size_t>(trigger.task)].name,
                                    format_time(now_), format_time(state.released)));
        state.pending = true;
        state.released = now_;
    }
}

void Executive::stimulate() {
    const auto& stimuli = machine_.stimuli;
    for (; next_stimulus_ < stimuli.size() && stimuli[next_stimulus_].at <= now_;
         ++next_stimulus_) {
        const Stimulus& s = stimuli[next_stimulus_];
        store(s.type, s.target, s.value);
    }
}

void Executive::finish_top() {
    while (!running_.empty() && states_[static_cast<std::size_t>(running_.back())].remaining == 0) {
        const int task = running_.back();
        running_.pop_back();
        publish(task);
    }
}

void Executive::release() {
    for (std::size_t i = 0; i < states_.size(); ++i) {
        State& state = states_[i];
        if (state.due > now_) continue;
        const Task& task = machine_.tasks[i];
        if (state.pending || state.active)
            return stop(
                Outcome::overrun,
                fmt::format("task '{}' overran: due again at {} in scan {}, before the scan "
                            "of {} had ended",
                            task.name, format_time(now_), state.index,
                            format_time(state.active ? state.scan.time : state.released)));
        state.pending = true;
        state.released = state.due;
        const std::int64_t off = task.jitter > 0 ? state.jitter.around_zero(task.jitter) : 0;
        state.due = later(later(state.due, task.every), off);
    }
}

void Executive::start_pending() {
    for (int i = next_to_start(); i >= 0 && !stopped_; i = next_to_start()) {
        if (repeats_without_end(i)) return;
        start(i);
        if (states_[static_cast<std::size_t>(i)].remaining > 0) {
            running_.push_back(i);
            return detect_edges();
        }
        publish(i);
    }
}

/// -1 when none is pending that may interrupt the scan under way.
int Executive::next_to_start() const {
    const auto& tasks = machine_.tasks;
    for (std::size_t i = 0; i < states_.size(); ++i) {
        if (!states_[i].pending) continue;
        const bool waits =
            !running_.empty() &&
            tasks[static_cast<std::size_t>(running_.back())].priority >= tasks[i].priority;
        return waits ? -1 : static_cast<int>(i);
    }
    return -1;
}

bool Executive::repeats_without_end(int index) {
    const Task& task = machine_.tasks[static_cast<std::size_t>(index)];
    State& state = states_[static_cast<std::size_t>(index)];
    if (!task.on_event) return false;
    state.repeats = state.scan.time == now_ ? state.repeats + 1 : 0;
    if (state.repeats < most_starts_at_once) return false;
    stop(Outcome::overrun, fmt::format("event task '{}' overran: {} scans at {}, and no end",
                                       task.name, state.repeats, format_time(now_)));
    return true;
}

void Executive::start(int index) {
    const Task& task = machine_.tasks[static_cast<std::size_t>(index)];
    State& state = states_[static_cast<std::size_t>(index)];
    state.pending = false;
    state.active = true;
    state.scan = {.time = now_, .interval = task.every, .index = state.index++};
    state.remaining =
        task.cost + (task.cost_jitter > 0 ? state.cost_jitter.around_zero(task.cost_jitter) : 0);
    const Copy* word = task.wires.words.data();
    const Copy* boolean = task.wires.booleans.data();
    const ConvertedCopy* conversion = task.wires.conversions.data();
    for (const Call& call : task.calls) {
        word = copy<8>(word, call.words);
        boolean = copy<1>(boolean, call.booleans);
        for (std::uint32_t n = call.conversions; n > 0; --n) convert(*conversion++);
        call.scan(call.block, state.scan);
    }
}

void Executive::publish(int index) {
    const Task& task = machine_.tasks[static_cast<std::size_t>(index)];
    State& state = states_[static_cast<std::size_t>(index)];
    state.active = false;
    if (task.published != task.live) std::memcpy(task.published, task.live, task.size);
    for (const DeviceCall& device : machine_.devices) {
        if (device.task != index) continue;
        device.calls.publish(device.block, now_);
        device.calls.advance(device.block, now_, device.sink);
    }
    ++result_.scans[static_cast<std::size_t>(index)];
    for (Observer* observer : *observers_) observer->scanned(index, state.scan);
    if (!machine_.continue_on_error) check_errors(task, state.scan);
    if (!stopped_) detect_edges();
}

void Executive::check_errors(const Task& task, const Scan& scan) {
    for (const ErrorFlag& flag : task.errors) {
        if (!*flag.error) continue;
        std::string text;
        if (flag.error_id) {
            const auto id = static_cast<std::size_t>(*flag.error_id);
            text = fmt::format(" {}", *flag.error_id);
            if (id < flag.names.size()) text += fmt::format(" ({})", flag.names[id]);
        }
        return stop(Outcome::block_error,
                    fmt::format("block {} reports error{} in scan {} of task '{}' at {}",
                                flag.block, text, scan.index, task.name, format_time(scan.time)));
    }
}

void Executive::stop(Outcome outcome, std::string message) {
    stopped_ = true;
    result_.outcome = outcome;
    result_.message = std::move(message);
    result_.time = now_;
}

}  // namespace lineshaft

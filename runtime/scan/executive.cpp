#include "runtime/scan/executive.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lineshaft {

namespace {

template <class T>
T read(const std::byte* slot) {
    T value;
    std::memcpy(&value, slot, sizeof value);
    return value;
}

template <std::size_t size>
const Copy* copy(const Copy* wire, std::uint32_t count) {
    for (; count > 0; --count, ++wire) std::memcpy(wire->target, wire->source, size);
    return wire;
}

void convert(const ConvertedCopy& wire) {
    if (wire.kind == ConvertedCopy::Kind::negated) {
        const bool value = !read<bool>(wire.source);
        std::memcpy(wire.target, &value, sizeof value);
        return;
    }
    const double given = wire.kind == ConvertedCopy::Kind::integer_to_real
                             ? static_cast<double>(read<std::int64_t>(wire.source))
                             : read<double>(wire.source);
    const double value = given * wire.factor / wire.divisor;
    std::memcpy(wire.target, &value, sizeof value);
}

void sow(const BlockSeed& seed, std::uint64_t run_seed) {
    if (std::get<std::int64_t>(load(Type::integer, seed.place)) != 0) return;
    const std::uint64_t drawn = Random(run_seed, seed.block + ".seed").next();
    store(Type::integer, seed.place, static_cast<std::int64_t>(drawn >> 1));
}

/// Hands out a task's wires, block by block.
class Feeder {
  public:
    explicit Feeder(const Wires& wires)
        : word_(wires.words.data()),
          boolean_(wires.booleans.data()),
          conversion_(wires.conversions.data()) {}

    void feed(const Call& call) {
        word_ = copy<8>(word_, call.words);
        boolean_ = copy<1>(boolean_, call.booleans);
        for (std::uint32_t n = call.conversions; n > 0; --n) convert(*conversion_++);
    }

  private:
    const Copy* word_;
    const Copy* boolean_;
    const ConvertedCopy* conversion_;
};

}  // namespace

std::string format_time(std::int64_t nanoseconds) {
    constexpr std::int64_t second = 1'000'000'000;
    std::string text = fmt::format("{}", nanoseconds / second);
    if (nanoseconds % second != 0) text += fmt::format(".{:09}", nanoseconds % second);
    if (text.find('.') != std::string::npos) text.erase(text.find_last_not_of('0') + 1);
    return text + " s";
}

Executive::Executive(Machine& machine) : machine_(machine), forces_(machine.forces) {
    for (const BlockSeed& seed : machine.block_seeds) sow(seed, machine.seed);
    for (const Task& task : machine.tasks) {
        states_.push_back({.jitter = Random(machine.seed, task.name + ".jitter"),
                           .cost_jitter = Random(machine.seed, task.name + ".cost"),
                           .due = task.on_event ? never : task.offset,
                           .first_error = error_levels_.size(),
                           .scan = {}});
        error_levels_.resize(error_levels_.size() + task.errors.size());
        look_ahead(static_cast<int>(states_.size()) - 1);
    }
    for (const Trigger& trigger : machine.triggers) trigger_levels_.push_back(*trigger.signal);
    running_.reserve(machine.tasks.size());
    result_.scans.resize(machine.tasks.size());
}

void Executive::checkpoint(std::int64_t every, std::function<void(std::int64_t)> save) {
    save_every_ = every;
    save_ = std::move(save);
}

RunResult Executive::run(const std::vector<Observer*>& observers,
                         const std::atomic<bool>* interrupt,
                         const std::function<void(std::int64_t)>& progress) {
    observers_ = &observers;
    if (save_) next_save_ = later(now_ / save_every_ * save_every_, save_every_);
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
        if (next > next_save_) {
            save_(now_);
            next_save_ = later((next - 1) / save_every_ * save_every_, save_every_);
        }
        if (instants % 4096 != 0) continue;
        if (progress) progress(now_);
        if (interrupt && *interrupt) {
            if (save_) save_(now_);
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

std::int64_t Executive::next_event() {
    std::int64_t next = forces_.next_time();
    for (const State& state : states_) next = std::min(next, state.due);
    if (next_stimulus_ < machine_.stimuli.size())
        next = std::min(next, machine_.stimuli[next_stimulus_].at);
    if (next_look_ < machine_.looks.size()) next = std::min(next, machine_.looks[next_look_]);
    for (const DeviceCall& device : machine_.devices)
        next = std::min(next, next_event_time(device));
    if (running_.empty()) return next;
    for (const int index : running_) next = std::min(next, state(index).deadline);
    return std::min(next, later(now_, state(running_.back()).remaining));
}

void Executive::advance(std::int64_t time) {
    if (!running_.empty()) state(running_.back()).remaining -= time - now_;
    now_ = time;
}

void Executive::instant() {
    advance_devices();
    force();
    stimulate();
    detect_edges();
    finish_top();
    if (!stopped_) check_deadlines();
    if (!stopped_) release();
    if (!stopped_) start_pending();
}

void Executive::finish_top() {
    while (!running_.empty() && state(running_.back()).remaining == 0) {
        const int index = running_.back();
        running_.pop_back();
        publish(index);
    }
}

void Executive::release() {
    for (std::size_t i = 0; i < states_.size() && !stopped_; ++i) {
        State& state = states_[i];
        if (state.due > now_) continue;
        const Task& task = machine_.tasks[i];
        if (state.pending || state.active) {
            due_again(static_cast<int>(i));
        } else {
            state.pending = true;
            state.released = state.due;
        }
        const std::int64_t off = task.jitter > 0 ? state.jitter.around_zero(task.jitter) : 0;
        state.due = later(later(state.due, task.every), off);
    }
}

void Executive::start_pending() {
    for (int i = next_to_start(); i >= 0 && !stopped_; i = next_to_start()) {
        if (repeats_without_end(i)) return;
        start(i);
        if (state(i).remaining > 0) {
            running_.push_back(i);
            return detect_edges();
        }
        publish(i);
    }
}

/// -1 when none is pending that may interrupt the scan under way.
int Executive::next_to_start() const {
    for (std::size_t i = 0; i < states_.size(); ++i) {
        if (!states_[i].pending) continue;
        const bool waits =
            !running_.empty() && task(running_.back()).priority >= machine_.tasks[i].priority;
        return waits ? -1 : static_cast<int>(i);
    }
    return -1;
}

void Executive::start(int index) {
    const Task& task = this->task(index);
    State& state = this->state(index);
    if (index == machine_.main_task) errors_in_cycle_ = 0;
    state.pending = false;
    state.active = true;
    state.scan = {.time = now_, .interval = task.every, .index = state.index++};
    state.cost =
        task.cost + (task.cost_jitter > 0 ? state.cost_jitter.around_zero(task.cost_jitter) : 0);
    if (state.scan.index == state.outside) stimulate(index);
    state.remaining = state.cost;
    state.deadline = state.cost > 0 ? later(now_, task.maximum_cycle_time) : never;
    if (forces_.active()) return scan_forced(task, state.scan);
    Feeder wires(task.wires);
    for (const Call& call : task.calls) {
        wires.feed(call);
        call.scan(call.block, state.scan);
    }
}

void Executive::scan_forced(const Task& task, const Scan& scan) {
    Feeder wires(task.wires);
    for (const Call& call : task.calls) {
        forces_.release_inputs(call.block);
        wires.feed(call);
        forces_.impose_inputs(call.block);
        forces_.release_outputs(call.block);
        call.scan(call.block, scan);
        forces_.impose_outputs(call.block);
    }
}

void Executive::publish(int index) {
    const Task& task = this->task(index);
    State& state = this->state(index);
    state.active = false;
    state.deadline = never;
    if (task.published != task.live) std::memcpy(task.published, task.live, task.size);
    if (forces_.active()) forces_.published(index);
    for (const DeviceCall& device : machine_.devices)
        if (device.task == index) publish_device(device);
    ++result_.scans[static_cast<std::size_t>(index)];
    for (Observer* observer : *observers_) observer->scanned(index, state.scan);
    check_errors(index);
    if (!stopped_) detect_edges();
}

}  // namespace lineshaft

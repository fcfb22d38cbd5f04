#include "runtime/scan/executive.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace lineshaft {

namespace {

constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

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

void move(const Copy& copy) {
    switch (copy.kind) {
        case Copy::Kind::word:
            std::memcpy(copy.target, copy.source, 8);
            break;
        case Copy::Kind::boolean:
            std::memcpy(copy.target, copy.source, 1);
            break;
        case Copy::Kind::negated: {
            const bool value = !read<bool>(copy.source);
            std::memcpy(copy.target, &value, 1);
            break;
        }
        case Copy::Kind::integer_to_real: {
            const auto whole = static_cast<double>(read<std::int64_t>(copy.source));
            const double value = whole * copy.factor / copy.divisor;
            std::memcpy(copy.target, &value, 8);
            break;
        }
        case Copy::Kind::scaled: {
            const double value = read<double>(copy.source) * copy.factor / copy.divisor;
            std::memcpy(copy.target, &value, 8);
            break;
        }
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
    for (const Task& task : machine.tasks) {
        states_.push_back({.jitter = Random(machine.seed, task.name + ".jitter"),
                           .cost_jitter = Random(machine.seed, task.name + ".cost"),
                           .due = task.offset,
                           .scan = {}});
    }
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
    now_ = result_.time = machine_.duration;
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
    stimulate();
    finish_top();
    if (!stopped_) release();
    if (!stopped_) start_pending();
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
    for (std::size_t i = 0; i < states_.size() && !stopped_; ++i) {
        if (!states_[i].pending) continue;
        const auto& tasks = machine_.tasks;
        if (!running_.empty() &&
            tasks[static_cast<std::size_t>(running_.back())].priority >= tasks[i].priority)
            return;
        start(static_cast<int>(i));
        if (states_[i].remaining > 0) {
            running_.push_back(static_cast<int>(i));
            return;
        }
        publish(static_cast<int>(i));
    }
}

void Executive::start(int index) {
    const Task& task = machine_.tasks[static_cast<std::size_t>(index)];
    State& state = states_[static_cast<std::size_t>(index)];
    state.pending = false;
    state.active = true;
    state.scan = {.time = now_, .interval = task.every, .index = state.index++};
    state.remaining =
        task.cost + (task.cost_jitter > 0 ? state.cost_jitter.around_zero(task.cost_jitter) : 0);
    const Copy* copy = task.copies.data();
    for (const Call& call : task.calls) {
        for (std::uint32_t n = call.copies; n > 0; --n) move(*copy++);
        call.scan(call.block, state.scan);
    }
}

void Executive::publish(int index) {
    const Task& task = machine_.tasks[static_cast<std::size_t>(index)];
    State& state = states_[static_cast<std::size_t>(index)];
    state.active = false;
    if (task.published != task.live) std::memcpy(task.published, task.live, task.size);
    ++result_.scans[static_cast<std::size_t>(index)];
    for (Observer* observer : *observers_) observer->scanned(index, state.scan);
    if (!machine_.continue_on_error) check_errors(task, state.scan);
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

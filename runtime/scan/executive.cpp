#include "runtime/scan/executive.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

void sow(const BlockSeed& seed, std::uint64_t run_seed) {
    if (std::get<std::int64_t>(load(Type::integer, seed.place)) != 0) return;
    const std::uint64_t drawn = Random(run_seed, seed.block + ".seed").next();
    store(Type::integer, seed.place, static_cast<std::int64_t>(drawn >> 1));
}

}  // namespace

Executive::Executive(Machine& machine) : machine_(machine), forces_(machine.forces) {
    for (const BlockSeed& seed : machine.block_seeds) sow(seed, machine.seed);
    for (const Task& task : machine.tasks) {
        states_.push_back({.due = task.on_event && !task.once ? never : task.offset,
                           .first_error = error_levels_.size(),
                           .scan = {},
                           .jitter = Random(machine.seed, task.name + ".jitter"),
                           .cost_jitter = Random(machine.seed, task.name + ".cost")});
        error_levels_.resize(error_levels_.size() + task.errors.size());
        look_ahead(static_cast<int>(states_.size()) - 1);
    }
    for (const Trigger& trigger : machine.triggers) trigger_levels_.push_back(*trigger.signal);
    interpolates_ =
        std::ranges::count(machine.replays, Replay::Between::interpolated, &Replay::between) > 0;
    nothing_waits_ = machine.devices.empty() && machine.triggers.empty() &&
                     std::ranges::none_of(machine.tasks, [](const Task& task) {
                         return task.takes_time() || task.on_overrun >= 0;
                     });
    warned_.resize(machine.devices.size());
    running_.reserve(machine.tasks.size());
    result_.scans.resize(machine.tasks.size());
    for (Task& task : machine.tasks)
        for (Call& call : task.calls) call.context.published = result_.scans.data();
}

void Executive::checkpoint(std::int64_t every, std::function<void(std::int64_t)> save) {
    save_every_ = every;
    save_ = std::move(save);
}

void Executive::look_out(const std::atomic<bool>* interrupt,
                         std::function<void(std::int64_t)> progress) {
    interrupt_ = interrupt;
    progress_ = std::move(progress);
}

RunResult Executive::run(const std::vector<Observer*>& observers,
                         const std::atomic<bool>* interrupt,
                         const std::function<void(std::int64_t)>& progress) {
    for (Observer* observer : observers) add(*observer);
    look_out(interrupt, progress);
    begin();
    run_until(machine_.duration);
    return finish();
}

void Executive::begin() {
    static constexpr std::byte never_true{};
    until_ = machine_.until ? machine_.until->slot : &never_true;
    look_ahead();
    if (save_) next_save_ = later(now_ / save_every_ * save_every_, save_every_);
    looked_ = Clock::now();
}

inline std::int64_t Executive::next_event() {
    const std::int64_t next = std::min(next_due_, next_outside_);
    return nothing_waits_ ? next : std::min(next, next_end());
}

inline void Executive::advance(std::int64_t time) {
    if (!running_.empty()) state(running_.back()).remaining -= time - now_;
    now_ = time;
}

inline void Executive::begin(int index, const Task& task, State& state) {
    state.scan = {.time = now_, .interval = task.every, .index = state.index++};
    if (state.scan.index == state.outside) stimulate(index);
}

/// Whether a block may have an error.
bool Executive::scan_blocks(const Task& task, const Scan& scan) {
    if (forces_.active()) {
        scan_forced(task, scan);
        return true;
    }
    bool error = false;
    for (const Call& call : task.calls) error |= call.run(call, scan);
    return error;
}

void Executive::show(int index, const Scan& scan) {
    for (Observer* observer : scan_observers_) observer->scanned(index, scan);
}

/// When what others see of the task's scan is in place.
inline void Executive::conclude(int index, const State& state) {
    ++result_.scans.data()[index];
    if (!scan_observers_.empty()) show(index, state.scan);
    if (state.may_err) report_errors(index);
}

inline void Executive::State::set_next(const Task& task) {
    if (task.once) {
        due = never;
        return;
    }
    const std::int64_t off = task.jitter > 0 ? jitter.around_zero(task.jitter) : 0;
    due = later(later(due, task.every), off);
}

inline void Executive::run_tasks() {
    const std::int64_t now = now_;
    std::int64_t next = never;
    int index = 0;
    const Task* task = machine_.tasks.data();
    for (State& state : states_) {
        if (state.due <= now && !stopped_) {
            begin(index, *task, state);
            state.may_err |= scan_blocks(*task, state.scan);
            conclude(index, state);
            state.set_next(*task);
        }
        next = std::min(next, state.due);
        ++index;
        ++task;
    }
    next_due_ = next;
}

/// Where nothing waits: what is due runs at once. So does what is due next, up to `last`, as long
/// as nothing comes in between and nobody looks on.
void Executive::run_due(std::int64_t last) {
    if (next_outside_ <= now_ || interpolates_) act_from_outside();
    if (next_due_ > now_) return;
    const bool is_seen = interpolates_ || !observers_.empty();
    const std::int64_t end = is_seen ? now_ : std::min({last, next_outside_ - 1, next_save_});
    for (;;) {
        run_tasks();
        if (next_due_ > end || until_look_ <= 1 || stopped_ || read<bool>(until_)) return;
        --until_look_;
        now_ = next_due_;
    }
}

bool Executive::run_until(std::int64_t time) {
    const std::int64_t last = std::min(time, machine_.duration);
    std::int64_t next = next_event();
    if (has_run_ && known_until_ <= last) settle(std::min(next - 1, last));
    while (!ended_ && next <= last) {
        advance(next);
        if (nothing_waits_)
            run_due(last);
        else
            instant();
        has_run_ = true;
        next = next_event();
        ended_ = stopped_ || read<bool>(until_);
        settle(ended_ ? now_ : std::min(next - 1, last));
        if (ended_) break;
        if (next > next_save_) {
            save_(now_);
            next_save_ = later((next - 1) / save_every_ * save_every_, save_every_);
        }
        if (--until_look_ == 0 && !look()) break;
    }
    result_.time = now_;
    const bool is_held = !ended_ && next <= last;
    if (!ended_ && !is_held) known_until_ = std::max(known_until_, last + 1);
    return is_held || (!ended_ && last < machine_.duration);
}

/// Nothing changes up to `last`.
void Executive::settle(std::int64_t last) {
    for (Observer* observer : observers_) observer->settled(now_, last + 1);
    known_until_ = last + 1;
}

void Executive::hold() {
    held_ = true;
    until_look_ = 1;
}

void Executive::interrupt() {
    stop(Outcome::interrupted, "interrupted at " + format_time(now_));
    ended_ = true;
}

/// A quarter of a millisecond of wall time after the last look, as far as that can be foreseen.
/// False: this step is over.
bool Executive::look() {
    if (std::exchange(held_, false)) {
        until_look_ = 1;
        return false;
    }
    constexpr std::chrono::duration<double> wanted = std::chrono::microseconds(250);
    const auto now = Clock::now();
    const double factor = wanted / std::max<std::chrono::duration<double>>(
                                       now - looked_, std::chrono::nanoseconds(100));
    looked_ = now;
    stride_ = std::clamp(stride_ * factor, 1.0, std::min(2 * stride_, 1e6));
    until_look_ = static_cast<std::uint32_t>(stride_);
    if (progress_) progress_(now_);
    if (!interrupt_ || !*interrupt_) return true;
    if (save_) save_(now_);
    interrupt();
    return true;
}

RunResult Executive::finish() {
    if (ended_) return result_;
    advance(std::max(now_, known_until_ - 1));
    advance_devices();
    result_.time = now_;
    if (machine_.until && now_ == machine_.duration)
        stop(Outcome::limit, fmt::format("'{}' did not become true within {}", machine_.until->name,
                                         format_time(machine_.duration)));
    return result_;
}

void Executive::add(Observer& observer) {
    observers_.push_back(&observer);
    if (observer.looks_at_scans()) scan_observers_.push_back(&observer);
}

void Executive::remove(Observer& observer) {
    std::erase(observers_, &observer);
    std::erase(scan_observers_, &observer);
}

std::int64_t Executive::post(Stimulus value) {
    value.at = known_until_;
    mail_.push_back(std::move(value));
    next_outside_ = std::min(next_outside_, known_until_);
    return known_until_;
}

std::optional<Value> Executive::posted(const std::byte* target) const {
    for (auto it = mail_.rbegin(); it != mail_.rend(); ++it)
        if (it->target == target) return it->value;
    return {};
}

void Executive::make_room(std::size_t values) {
    const auto grow = [values](auto& list) {
        if (list.capacity() < list.size() + values)
            list.reserve(std::max(2 * list.capacity(), list.size() + values));
    };
    grow(mail_);
    grow(machine_.forces);
}

std::int64_t Executive::force(Force force) {
    force.from = known_until_;
    machine_.impose(std::move(force));
    return forces_changed();
}

std::int64_t Executive::lift_force(const std::byte* live) {
    machine_.lift_force(live, known_until_);
    return forces_changed();
}

std::int64_t Executive::forces_changed() {
    forces_.forget_ended(known_until_ - 1);
    look_ahead();
    return known_until_;
}

/// What next_due_, next_outside_ and pending_ summarise.
void Executive::look_ahead() {
    next_due_ = never;
    pending_ = 0;
    for (const State& state : states_) {
        next_due_ = std::min(next_due_, state.due);
        pending_ += state.pending;
    }
    next_outside_ = forces_.next_time();
    for (const Replay& replay : machine_.replays)
        next_outside_ = std::min(next_outside_, replay.next_time());
    if (next_stimulus_ < machine_.stimuli.size())
        next_outside_ = std::min(next_outside_, machine_.stimuli[next_stimulus_].at);
    if (next_look_ < machine_.looks.size())
        next_outside_ = std::min(next_outside_, machine_.looks[next_look_]);
    if (!mail_.empty()) next_outside_ = std::min(next_outside_, mail_.front().at);
}

std::int64_t Executive::next_time() {
    return next_event();
}

/// When the first of what waits is due: a device's next moment, the end of the scan under way, a
/// deadline.
std::int64_t Executive::next_end() {
    std::int64_t next = never;
    for (const DeviceCall& device : machine_.devices)
        next = std::min(next, next_event_time(device));
    if (running_.empty()) return next;
    for (const int index : running_) next = std::min(next, state(index).deadline);
    return std::min(next, later(now_, state(running_.back()).remaining));
}

void Executive::instant() {
    if (!machine_.devices.empty()) advance_devices();
    if (next_outside_ <= now_ || interpolates_) act_from_outside();
    if (!trigger_levels_.empty()) detect_edges();
    finish_top();
    if (!stopped_ && !running_.empty()) check_deadlines();
    if (!stopped_ && next_due_ <= now_) release();
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
    next_due_ = never;
    int index = 0;
    for (State& state : states_) {
        if (state.due <= now_ && !stopped_) release(index, state);
        next_due_ = std::min(next_due_, state.due);
        ++index;
    }
}

void Executive::release(int index, State& state) {
    const Task& task = this->task(index);
    if (state.pending || state.active) {
        due_again(index);
    } else {
        make_pending(index);
        state.released = state.due;
    }
    state.set_next(task);
}

void Executive::make_pending(int index) {
    bool& pending = state(index).pending;
    pending_ += !pending;
    pending = true;
}

void Executive::start_pending() {
    while (pending_ > 0 && !stopped_) {
        const int i = next_to_start();
        if (i < 0 || (task(i).on_event && repeats_without_end(i))) return;
        start(i);
        if (state(i).remaining > 0) {
            running_.push_back(i);
            return detect_edges();
        }
        publish(i);
    }
}

/// The first of those that are pending; -1 when it may not interrupt the scan under way.
int Executive::next_to_start() const {
    int i = 0;
    while (!state(i).pending) ++i;
    const bool waits = !running_.empty() && task(running_.back()).priority >= task(i).priority;
    return waits ? -1 : i;
}

void Executive::start(int index) {
    const Task& task = this->task(index);
    State& state = this->state(index);
    if (index == machine_.main_task) errors_in_cycle_ = 0;
    state.pending = false;
    --pending_;
    state.active = true;
    state.cost =
        task.cost + (task.cost_jitter > 0 ? state.cost_jitter.around_zero(task.cost_jitter) : 0);
    const std::size_t said = state.next_cost;
    begin(index, task, state);
    state.may_err |= scan_blocks(task, state.scan);
    if (state.next_cost == said)
        for (const std::int64_t* taken : task.times_taken) state.cost = later(state.cost, *taken);
    state.remaining = state.cost;
    state.deadline = state.cost > 0 ? later(now_, task.maximum_cycle_time) : never;
}

void Executive::scan_forced(const Task& task, const Scan& scan) {
    for (const Call& call : task.calls) {
        for (std::size_t i = 0; i < call.count; ++i) forces_.lift_inputs(call.block(i));
        feed(call);
        for (std::size_t i = 0; i < call.count; ++i) forces_.impose_inputs(call.block(i));
        for (std::size_t i = 0; i < call.count; ++i) forces_.lift_outputs(call.block(i));
        call.scan(call.first, call.count, scan, call.context);
        for (std::size_t i = 0; i < call.count; ++i) forces_.impose_outputs(call.block(i));
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
    conclude(index, state);
    if (!stopped_ && !trigger_levels_.empty()) detect_edges();
}

}  // namespace lineshaft

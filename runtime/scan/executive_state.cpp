#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "runtime/machine/kept_memory.hpp"
#include "runtime/scan/executive.hpp"

namespace lineshaft {

namespace {

/// A place in the machine's memory, as a number; -1 for none.
std::int64_t number_of(const Machine& machine, const std::byte* place) {
    return place ? place - machine.memory.data() : -1;
}

std::byte* place_of(Machine& machine, std::int64_t number) {
    return number < 0 ? nullptr : machine.memory.data() + number;
}

/// Within the memory, or none.
void get_place(StateReader& in, Machine& machine, auto& place) {
    std::int64_t number = -1;
    in.get(number, -1, std::ssize(machine.memory) - 1);
    place = place_of(machine, number);
}

void put_value(StateWriter& out, Type type, const Value& value) {
    std::array<std::byte, 8> bytes{};
    store(type, bytes.data(), value);
    out.put(static_cast<std::uint8_t>(type));
    out.put(bytes);
}

void get_value(StateReader& in, Type& type, Value& value) {
    constexpr auto last = static_cast<std::uint8_t>(Type::unsigned_integer);
    std::uint8_t number = 0;
    std::array<std::byte, 8> bytes{};
    in.get(number, 0, last);
    in.get(bytes);
    type = static_cast<Type>(number);
    in.require(type != Type::boolean || read<unsigned char>(bytes.data()) <= 1);
    if (in.ok()) value = load(type, bytes.data());
}

void save(StateWriter& out, const Machine& machine, const Force& force) {
    out.put(number_of(machine, force.live));
    out.put(number_of(machine, force.published));
    out.put(number_of(machine, force.block));
    out.put(force.from);
    out.put(force.until);
    out.put(force.is_output);
    out.put(force.stays);
    out.put(force.task);
    put_value(out, force.type, force.value);
    out.put(force.name);
    out.put(force.value_text);
}

void restore(StateReader& in, Machine& machine, Force& force) {
    get_place(in, machine, force.live);
    get_place(in, machine, force.published);
    get_place(in, machine, force.block);
    in.get(force.from);
    in.get(force.until);
    in.get(force.is_output);
    in.get(force.stays);
    in.get(force.task, -1, static_cast<int>(machine.tasks.size()) - 1);
    get_value(in, force.type, force.value);
    in.get(force.name);
    in.get(force.value_text);
}

void save(StateWriter& out, const Machine& machine, const Stimulus& stimulus) {
    out.put(number_of(machine, stimulus.target));
    out.put(stimulus.at);
    put_value(out, stimulus.type, stimulus.value);
    out.put(stimulus.text);
}

void restore(StateReader& in, Machine& machine, Stimulus& stimulus) {
    get_place(in, machine, stimulus.target);
    in.get(stimulus.at);
    get_value(in, stimulus.type, stimulus.value);
    in.get(stimulus.text);
}

template <class Each>
void save_list(StateWriter& out, const Machine& machine, const std::vector<Each>& list) {
    out.put(std::uint64_t{list.size()});
    for (const Each& each : list) save(out, machine, each);
}

template <class Each>
void restore_list(StateReader& in, Machine& machine, std::vector<Each>& list) {
    std::uint64_t size = 0;
    in.get(size);
    list.clear();
    for (; in.ok() && size > 0; --size) restore(in, machine, list.emplace_back());
}

}  // namespace

void Executive::save(StateWriter& out) const {
    out.put(machine_.memory);
    out.put(now_);
    save_list(out, machine_, machine_.forces);
    forces_.save(out);
    save_list(out, machine_, mail_);
    for (const State& state : states_)
        State::visit(state, [&out](const auto& part) { out.put(part); });
    out.put(trigger_levels_);
    out.put(error_levels_);
    out.put(warned_);
    out.put(std::uint64_t{running_.size()});
    for (const int index : running_) out.put(index);
    out.put(next_stimulus_);
    out.put(next_look_);
    out.put(known_until_);
    out.put(has_run_);
    out.put(errors_in_cycle_);
    out.put(result_.scans);
    out.put(result_.time_errors);
}

void Executive::restore(StateReader& in) {
    std::vector<std::byte> kept(machine_.memory.size());
    in.get(kept);
    in.get(now_, 0, never - 1);
    if (!in.ok()) return;
    KeptMemory memory(machine_, now_);
    restore_memory(in, memory, kept.data());
    restore_forces(in, memory);
    restore_mail(in, memory);
    restore_states(in);
    in.get(next_stimulus_, 0, machine_.stimuli.size());
    in.get(next_look_, 0, machine_.looks.size());
    in.get(known_until_, now_, never);
    in.get(has_run_);
    in.get(errors_in_cycle_, 0, std::numeric_limits<int>::max() - 1);
    in.get(result_.scans);
    in.require(std::ranges::all_of(result_.scans, is_count), "a number of scans");
    in.get(result_.time_errors);
    in.require(is_count(result_.time_errors));
    if (!in.ok()) return;
    forces_.look_ahead(known_until_ - 1);
    constexpr std::int64_t before_all = std::numeric_limits<std::int64_t>::min();
    for (Replay& replay : machine_.replays) replay.skip_to(has_run_ ? now_ : before_all);
}

void Executive::recall(StateReader& in) {
    StateReader before = in, memory = in;
    before.get(machine_.memory);
    restore(in);
    memory.get(machine_.memory);
}

void Executive::restore_memory(StateReader& in, KeptMemory& memory, const std::byte* kept) {
    const std::byte* const first = machine_.memory.data();
    // recall() has taken it as a whole.
    if (std::equal(machine_.memory.begin(), machine_.memory.end(), kept)) return;
    for (const Signal& signal : machine_.signals) {
        if (signal.port.instance >= 0) continue;
        std::byte* const place = machine_.live(signal.port);
        const std::byte* const value = kept + (place - first);
        in.require(signal.type != Type::boolean || read<unsigned char>(value) <= 1, signal.name);
        in.require(
            signal.type != Type::enumeration || signal.names.takes(read<std::int64_t>(value)),
            signal.name);
        if (in.ok()) std::copy_n(value, size_of(signal.type), place);
    }
    for (const BlockPlace& block : machine_.blocks) {
        memory.take(block, block.live, kept + (block.live - first));
        if (block.published != block.live)
            memory.take(block, block.published, kept + (block.published - first));
    }
    const std::string damaged = memory.damaged();
    in.require(damaged.empty(), "the state of " + damaged);
}

void Executive::restore_forces(StateReader& in, const KeptMemory& memory) {
    restore_list(in, machine_, machine_.forces);
    for (const Force& force : machine_.forces) {
        const bool is_of_block =  // the process image stands in the list before and behind its task
            !force.block || std::ranges::find(machine_.blocks, force.block, &BlockPlace::live) !=
                                machine_.blocks.end();
        in.require(force.live && is_of_block && memory.is_signal(force.live, force.type, false) &&
                       (!force.published || memory.is_signal(force.published, force.type, true)),
                   "a force");
    }
    if (!in.ok()) return machine_.forces.clear();
    forces_.look_ahead(-1);
    forces_.restore(in);
}

void Executive::restore_mail(StateReader& in, const KeptMemory& memory) {
    restore_list(in, machine_, mail_);
    for (const Stimulus& value : mail_)
        in.require(
            value.target && memory.is_signal(value.target, value.type, false) && value.at >= now_,
            "a value from outside");
    if (!in.ok()) mail_.clear();
}

/// A task that is under way is on the stack of those that run, once.
void Executive::restore_states(StateReader& in) {
    const std::vector<State> fresh = states_;
    for (State& state : states_) State::visit(state, [&in](auto& part) { in.get(part); });
    for (std::size_t i = 0; i < states_.size(); ++i)
        in.require(is_possible(states_[i], fresh[i], machine_.tasks[i]),
                   fmt::format("the state of task '{}'", machine_.tasks[i].name));
    if (!in.ok()) states_ = fresh;
    in.get(trigger_levels_);
    in.get(error_levels_);
    in.get(warned_);
    for (std::size_t i = 0; i < warned_.size(); ++i) {
        const ValueNames& names = machine_.devices[i].warnings.names;
        in.require(is_count(warned_[i].count) && (warned_[i].id == 0 || names.takes(warned_[i].id)),
                   "a count of warnings");
    }
    std::uint64_t running = 0;
    in.get(running, 0, states_.size());
    for (; in.ok() && running > 0; --running) {
        int index = 0;
        in.get(index, 0, static_cast<int>(states_.size()) - 1);
        in.require(std::ranges::find(running_, index) == running_.end() && state(index).active &&
                   state(index).remaining > 0);
        running_.push_back(index);
    }
    for (std::size_t i = 0; i < states_.size(); ++i)
        in.require(!states_[i].active ||
                   std::ranges::find(running_, static_cast<int>(i)) != running_.end());
    for (std::size_t i = 0; in.ok() && i < states_.size(); ++i) look_ahead(static_cast<int>(i));
}

/// Nothing that is due lies before the machine's time: there is nothing to be made up for.
bool Executive::is_possible(const State& state, const State& fresh, const Task& task) const {
    const auto is_later = [this](std::int64_t time) { return time >= now_; };
    return is_later(later(state.due, task.every)) &&
           (!task.on_event || task.once || state.due == never) && state.released >= 0 &&
           state.released <= now_ && is_count(state.cost) && is_count(state.remaining) &&
           state.remaining <= state.cost && is_later(state.deadline) && is_count(state.index) &&
           is_count(state.repeats) && state.next_stimulus <= task.stimuli.size() &&
           state.next_cost <= task.costs.size() && state.first_error == fresh.first_error &&
           state.scan.time >= 0 && state.scan.time <= now_ && state.scan.interval >= 0 &&
           is_count(state.scan.index);
}

}  // namespace lineshaft

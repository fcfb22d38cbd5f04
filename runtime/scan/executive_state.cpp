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

void get_place(StateReader& in, Machine& machine, auto& place) {
    std::int64_t number = -1;
    in.get(number);
    place = place_of(machine, number);
}

void save(StateWriter& out, const Machine& machine, const Force& force) {
    out.put(number_of(machine, force.live));
    out.put(number_of(machine, force.published));
    out.put(number_of(machine, force.block));
    out.put(force.from);
    out.put(force.until);
    out.put(force.is_output);
    out.put(force.task);
    out.put(force.type);
    out.put(force.value);
    out.put(force.name);
    out.put(force.text);
}

void restore(StateReader& in, Machine& machine, Force& force) {
    get_place(in, machine, force.live);
    get_place(in, machine, force.published);
    get_place(in, machine, force.block);
    in.get(force.from);
    in.get(force.until);
    in.get(force.is_output);
    in.get(force.task);
    in.get(force.type);
    in.get(force.value);
    in.get(force.name);
    in.get(force.text);
}

void save(StateWriter& out, const Machine& machine, const Stimulus& stimulus) {
    out.put(number_of(machine, stimulus.target));
    out.put(stimulus.at);
    out.put(stimulus.type);
    out.put(stimulus.value);
    out.put(stimulus.text);
}

void restore(StateReader& in, Machine& machine, Stimulus& stimulus) {
    get_place(in, machine, stimulus.target);
    in.get(stimulus.at);
    in.get(stimulus.type);
    in.get(stimulus.value);
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
    save_list(out, machine_, machine_.forces);
    forces_.save(out);
    save_list(out, machine_, mail_);
    out.put(states_);
    out.put(trigger_levels_);
    out.put(error_levels_);
    out.put(warned_);
    out.put(std::uint64_t{running_.size()});
    for (const int index : running_) out.put(index);
    out.put(next_stimulus_);
    out.put(next_look_);
    out.put(now_);
    out.put(known_until_);
    out.put(has_run_);
    out.put(errors_in_cycle_);
    out.put(result_.scans);
    out.put(result_.time_errors);
}

void Executive::restore(StateReader& in) {
    std::uint64_t running = 0;
    in.get(machine_.memory);
    restore_list(in, machine_, machine_.forces);
    forces_.look_ahead(-1);
    forces_.restore(in);
    restore_list(in, machine_, mail_);
    in.get(states_);
    in.get(trigger_levels_);
    in.get(error_levels_);
    in.get(warned_);
    in.get(running);
    for (; in.ok() && running > 0; --running) in.get(running_.emplace_back());
    in.get(next_stimulus_);
    in.get(next_look_);
    in.get(now_);
    in.get(known_until_);
    in.get(has_run_);
    in.get(errors_in_cycle_);
    in.get(result_.scans);
    in.get(result_.time_errors);
    forces_.look_ahead(known_until_ - 1);
    for (Replay& replay : machine_.replays) replay.skip_to(now_);
}

}  // namespace lineshaft

#include "runtime/scan/executive.hpp"

namespace lineshaft {

void Executive::save(StateWriter& out) const {
    out.put(machine_.memory);
    forces_.save(out);
    out.put(states_);
    out.put(trigger_levels_);
    out.put(error_levels_);
    out.put(warned_);
    out.put(std::uint64_t{running_.size()});
    for (const int index : running_) out.put(index);
    out.put(next_stimulus_);
    out.put(next_look_);
    out.put(now_);
    out.put(errors_in_cycle_);
    out.put(result_.scans);
    out.put(result_.time_errors);
}

void Executive::restore(StateReader& in) {
    std::uint64_t running = 0;
    in.get(machine_.memory);
    forces_.restore(in);
    in.get(states_);
    in.get(trigger_levels_);
    in.get(error_levels_);
    in.get(warned_);
    in.get(running);
    for (; in.ok() && running > 0; --running) in.get(running_.emplace_back());
    in.get(next_stimulus_);
    in.get(next_look_);
    in.get(now_);
    in.get(errors_in_cycle_);
    in.get(result_.scans);
    in.get(result_.time_errors);
    forces_.look_ahead(now_);
    for (Replay& replay : machine_.replays) replay.skip_to(now_);
}

}  // namespace lineshaft

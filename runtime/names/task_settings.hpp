#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/model/device.hpp"

namespace lineshaft {

/// One scan of a task takes another time than the others, so that an overrun can be played in.
struct CostStimulus {
    std::int64_t scan = 0;
    std::int64_t cost = 0;  ///< execution time of that scan [ns]
};

/// What a program says of a task. Times in ns.
struct TaskSettings {
    std::string name;
    bool on_event = false;  ///< not cyclic: released by triggers, or by other tasks' overruns
    bool once = false;      ///< released by the start alone, before all others
    bool motion = false;    ///< an overrun is STOP whatever the program says
    std::int64_t every = 0, offset = 0, priority = 1, jitter = 0, cost = 0, cost_jitter = 0;
    std::int64_t maximum_cycle_time = never;  ///< from the start of a scan to its end
    int on_overrun = -1;                      ///< index of the time-error task; -1: STOP
    std::vector<CostStimulus> costs;          ///< sorted

    bool is_timed = false;  ///< a block in it says what its scan took

    bool takes_time() const { return cost > 0 || cost_jitter > 0 || !costs.empty() || is_timed; }
};

}  // namespace lineshaft

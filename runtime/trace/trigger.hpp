#pragma once

#include <cstdint>

#include "runtime/machine/machine.hpp"
#include "runtime/model/state.hpp"
#include "runtime/program/program.hpp"

namespace lineshaft {

/// What begins a trace's measurement: the first scan in which the condition holds while it did not
/// in the scan before. A condition that holds in the very first scan begins it at once; an edge
/// needs a scan before it.
struct TraceTrigger {
    TriggerKind kind = TriggerKind::immediate;
    Signal signal = {};
    Value low = 0.0;
    Value high = 0.0;

    /// Whether the signal's present value is one that triggers.
    bool condition_holds() const;
};

/// Watches a trigger from scan to scan.
class TriggerWatch {
  public:
    explicit TriggerWatch(const TraceTrigger& trigger);

    /// True in the scan in which the trigger comes.
    bool fires();

    void save(StateWriter& out) const { out.put(held_); }
    void restore(StateReader& in) { in.get(held_); }

  private:
    const TraceTrigger& trigger_;
    bool held_;  ///< in the scan before
};

}  // namespace lineshaft

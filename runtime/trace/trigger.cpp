#include "runtime/trace/trigger.hpp"

namespace lineshaft {

bool TraceTrigger::condition_holds() const {
    if (kind == TriggerKind::immediate) return true;
    const double value = as_real(signal.value());
    switch (kind) {
        case TriggerKind::immediate:
            break;
        case TriggerKind::rising:
            return value != 0;
        case TriggerKind::falling:
            return value == 0;
        case TriggerKind::above:
            return value > low;
        case TriggerKind::below:
            return value < high;
        case TriggerKind::inside:
            return value >= low && value <= high;
        case TriggerKind::equals:
            return value == low;
    }
    return true;
}

TriggerWatch::TriggerWatch(const TraceTrigger& trigger)
    : trigger_(trigger),
      held_(trigger.kind == TriggerKind::rising || trigger.kind == TriggerKind::falling) {}

bool TriggerWatch::fires() {
    const bool holds = trigger_.condition_holds();
    const bool comes = holds && !held_;
    held_ = holds;
    return comes;
}

}  // namespace lineshaft

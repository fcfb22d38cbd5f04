#include "runtime/trace/trigger.hpp"

namespace lineshaft {

bool TraceTrigger::condition_holds() const {
    if (kind == TriggerKind::immediate) return true;
    const Value value = signal.value();
    switch (kind) {
        case TriggerKind::immediate:
            break;
        case TriggerKind::rising:
            return std::get<bool>(value);
        case TriggerKind::falling:
            return !std::get<bool>(value);
        case TriggerKind::above:
            return compare(value, low) > 0;
        case TriggerKind::below:
            return compare(value, high) < 0;
        case TriggerKind::inside:
            return compare(value, low) >= 0 && compare(value, high) <= 0;
        case TriggerKind::equals:
            return compare(value, low) == 0;
    }
    return true;
}

TriggerWatch::TriggerWatch(const TraceTrigger& trigger)
    : trigger_(trigger),
      held_(trigger.kind == TriggerKind::rising || trigger.kind == TriggerKind::falling) {}

bool TriggerWatch::fires() {
    return rising_edge(trigger_.condition_holds(), held_);
}

}  // namespace lineshaft

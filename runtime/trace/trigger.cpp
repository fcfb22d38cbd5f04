#include "runtime/trace/trigger.hpp"

namespace lineshaft {

bool TraceTrigger::condition_holds() const {
    if (kind == Kind::immediate) return true;
    const double value = as_real(signal.value());
    switch (kind) {
        case Kind::immediate:
            break;
        case Kind::rising:
            return value != 0;
        case Kind::falling:
            return value == 0;
        case Kind::above:
            return value > low;
        case Kind::below:
            return value < high;
        case Kind::inside:
            return value >= low && value <= high;
        case Kind::equals:
            return value == low;
    }
    return true;
}

TriggerWatch::TriggerWatch(const TraceTrigger& trigger)
    : trigger_(trigger),
      held_(trigger.kind == TraceTrigger::Kind::rising ||
            trigger.kind == TraceTrigger::Kind::falling) {}

bool TriggerWatch::fires() {
    const bool holds = trigger_.condition_holds();
    const bool comes = holds && !held_;
    held_ = holds;
    return comes;
}

}  // namespace lineshaft

#include "runtime/scan/machine.hpp"

#include <algorithm>

namespace lineshaft {

const Signal* Machine::find(std::string_view name) const {
    const auto it = std::ranges::find(signals, name, &Signal::name);
    return it == signals.end() ? nullptr : &*it;
}

}  // namespace lineshaft

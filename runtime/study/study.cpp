#include "runtime/study/study.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

bool Bounds::hold(double value) const {
    if (!judged()) return true;
    if (at_least && !(value >= *at_least)) return false;
    if (at_most && !(value <= *at_most)) return false;
    return within.empty() || std::ranges::any_of(within, [&](double distance) {
               return std::abs(value - *paper) <= distance;
           });
}

}  // namespace lineshaft

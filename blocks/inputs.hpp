#pragma once

#include <cmath>

/// What blocks ask of their inputs.
namespace lineshaft {

template <class... T>
bool all_finite(T... values) {
    return (std::isfinite(values) && ...);
}

/// True once per rising edge of `now`; `last` remembers.
inline bool rising_edge(bool now, bool& last) {
    const bool edge = now && !last;
    last = now;
    return edge;
}

}  // namespace lineshaft

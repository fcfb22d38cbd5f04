#pragma once

#include <cmath>

/// What blocks ask of their inputs.
namespace lineshaft {

template <class... T>
bool all_finite(T... values) {
    return (std::isfinite(values) && ...);
}

}  // namespace lineshaft

#pragma once

#include <cmath>
#include <string_view>

/// What blocks ask of their inputs.
namespace lineshaft {

template <class... T>
bool all_finite(T... values) {
    return (std::isfinite(values) && ...);
}

/// `error_id` of a block that has nothing else to complain of.
inline constexpr std::string_view input_error_names[] = {"none", "not_finite"};

}  // namespace lineshaft

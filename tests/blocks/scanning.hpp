#pragma once

#include <cstdint>
#include <limits>

#include "runtime/model/scan.hpp"

/// What the tests of blocks share.
namespace lineshaft::test {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinite = std::numeric_limits<double>::infinity();
inline constexpr double largest = std::numeric_limits<double>::max();
inline constexpr double denormal = std::numeric_limits<double>::denorm_min();
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

inline constexpr std::int64_t millisecond = 1'000'000;
inline constexpr std::int64_t microsecond = 1'000;

/// Calls a block with the scans of a cyclic task.
struct Clock {
    std::int64_t interval = millisecond;
    std::int64_t index = 0;  ///< of the next scan

    std::int64_t time() const { return index * interval; }

    template <class Block>
    void scan(Block& block) {
        block.scan({.time = time(), .interval = interval, .index = index});
        ++index;
    }
};

}  // namespace lineshaft::test

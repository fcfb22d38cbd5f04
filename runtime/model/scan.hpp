#pragma once

#include <cstdint>

namespace lineshaft {

/// What a block knows of the moment it is called.
struct Scan {
    std::int64_t time =
        0;  ///< start of this scan in virtual time [ns], the same for all its blocks
    std::int64_t interval = 0;  ///< nominal interval of the task [ns]
    std::int64_t index = 0;     ///< scans of this task before this one
};

/// Nanoseconds to seconds; correctly rounded.
constexpr double seconds(std::int64_t nanoseconds) {
    return static_cast<double>(nanoseconds) / 1e9;
}

}  // namespace lineshaft

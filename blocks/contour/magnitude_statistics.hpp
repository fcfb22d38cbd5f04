#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lineshaft {

/// Running mean, root mean square and greatest of the magnitudes of a deviation.
struct MagnitudeStatistics {
    double mean = 0, rms = 0, greatest = 0;
    double sum = 0, squares = 0;
    std::int64_t count = 0;

    void add(double deviation) {
        const double size = std::abs(deviation);
        ++count;
        sum += size;
        squares += size * size;
        mean = sum / static_cast<double>(count);
        rms = std::sqrt(squares / static_cast<double>(count));
        greatest = std::max(greatest, size);
    }
};

}  // namespace lineshaft

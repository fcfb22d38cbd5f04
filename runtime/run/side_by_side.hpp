#pragma once

#include <cstdint>
#include <functional>

namespace lineshaft {

/// Calls `work` in `jobs` threads, this one included, or in as many as the machine gives; returns
/// when all have ended. When one throws, `stop` is called, which shall make the others end soon,
/// and the first exception is thrown on.
void side_by_side(std::int64_t jobs, const std::function<void()>& work,
                  const std::function<void()>& stop);

}  // namespace lineshaft

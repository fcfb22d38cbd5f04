#pragma once

#include <cstdint>

namespace lineshaft::test {

/// Allocations by operator new in this thread so far; the test binary replaces it to count.
std::int64_t allocations();

}  // namespace lineshaft::test

#pragma once

#include <cstdint>
#include <cstdlib>

namespace lineshaft::test {

/// The whole number that an environment variable says: how many a test draws in tools/long, or the
/// seed to begin with.
inline std::int64_t count_of(const char* variable, std::int64_t otherwise) {
    const char* const said = std::getenv(variable);
    return said ? std::atoll(said) : otherwise;
}

}  // namespace lineshaft::test

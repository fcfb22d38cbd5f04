#pragma once

#include <cstdint>
#include <string_view>

namespace lineshaft {

/// Seeded generator of one named use ("main.jitter"), so that adding a use elsewhere does not
/// change its draws. SplitMix64 (Steele, Lea, Flood 2014): the same numbers on every machine.
class Random {
  public:
    constexpr Random(std::uint64_t seed, std::string_view name) : state_(0xcbf29ce484222325) {
        for (const char c : name) state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001b3;
        state_ ^= seed * 0x9e3779b97f4a7c15;
    }

    std::uint64_t next();

    /// Whole number in [0, count), each equally likely (to 2^-64 of the range).
    std::uint64_t below(std::uint64_t count);

    /// Likewise in [-spread, spread].
    std::int64_t around_zero(std::int64_t spread);

    /// In (0, 1): the middle of one of 2^52 equal parts.
    double share();

    /// Draws from the standard normal distribution (Box and Muller 1958).
    double normal();

  private:
    std::uint64_t state_;
};

}  // namespace lineshaft

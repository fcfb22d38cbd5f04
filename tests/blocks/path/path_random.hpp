#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace lineshaft::test {

/// Numbers that a seed draws.
class Random {
  public:
    explicit Random(std::uint64_t seed) : numbers(seed) {}
    double share() { return static_cast<double>(numbers() >> 11) * 0x1p-53; }
    double between(double least, double most) { return least + (most - least) * share(); }
    double decades(double least, double most) { return std::pow(10, between(least, most)); }

  private:
    std::mt19937_64 numbers;
};

}  // namespace lineshaft::test

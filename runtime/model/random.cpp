#include "runtime/model/random.hpp"

#include <cmath>

#include <sleef.h>

namespace lineshaft {

std::uint64_t Random::next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

std::uint64_t Random::below(std::uint64_t count) {
    __extension__ using Product = unsigned __int128;
    return static_cast<std::uint64_t>((static_cast<Product>(next()) * count) >> 64);
}

std::int64_t Random::around_zero(std::int64_t spread) {
    const auto size = static_cast<std::uint64_t>(spread);
    return static_cast<std::int64_t>(below(2 * size + 1) - size);
}

double Random::share() {
    return (static_cast<double>(next() >> 12) + 0.5) * 0x1p-52;
}

double Random::normal() {
    const double radius = std::sqrt(-2 * Sleef_cinz_logd1_u10purec(share()));
    return radius * Sleef_cinz_cospid1_u05purec(2 * share());
}

}  // namespace lineshaft

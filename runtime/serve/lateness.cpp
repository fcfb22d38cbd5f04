#include "runtime/serve/lateness.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lineshaft {

void Lateness::add(std::int64_t nanoseconds) {
    nanoseconds = std::max<std::int64_t>(nanoseconds, 0);
    ++counts_[static_cast<std::size_t>(bucket_of(nanoseconds))];
    ++count_;
    greatest_ = std::max(greatest_, nanoseconds);
}

/// Times below 32 ns have a bucket each, then each octave has 32.
int Lateness::bucket_of(std::int64_t nanoseconds) {
    if (nanoseconds < steps) return static_cast<int>(nanoseconds);
    const auto octave =
        static_cast<int>(std::bit_width(static_cast<std::uint64_t>(nanoseconds) / steps));
    return octave * steps + static_cast<int>(nanoseconds >> (octave - 1)) - steps;
}

std::int64_t Lateness::end_of(int bucket) {
    if (bucket < steps) return bucket + 1;
    const int octave = bucket / steps;
    const std::int64_t place = bucket % steps + steps + 1;
    return octave == octaves && place == 2 * steps ? INT64_MAX : place << (octave - 1);
}

std::int64_t Lateness::quantile(double part) const {
    const auto wanted = static_cast<std::int64_t>(std::ceil(part * static_cast<double>(count_)));
    std::int64_t sum = 0;
    for (int bucket = 0; bucket < static_cast<int>(counts_.size()); ++bucket) {
        sum += counts_[static_cast<std::size_t>(bucket)];
        if (sum > 0 && sum >= wanted) return std::min(end_of(bucket) - 1, greatest_);
    }
    return 0;
}

std::vector<Lateness::Bucket> Lateness::histogram() const {
    std::vector<Bucket> powers;
    for (std::size_t first = 0; first < counts_.size(); first += steps) {
        std::int64_t sum = 0;
        for (std::size_t i = first; i < first + steps; ++i) sum += counts_[i];
        if (sum > 0 || !powers.empty())
            powers.push_back({end_of(static_cast<int>(first) + steps - 1), sum});
    }
    while (!powers.empty() && powers.back().count == 0) powers.pop_back();
    return powers;
}

}  // namespace lineshaft

#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace lineshaft {

/// How late something was, many times: counts in buckets whose width is at most 1/32 of their
/// times. Adding one takes no memory.
class Lateness {
  public:
    void add(std::int64_t nanoseconds);

    std::int64_t count() const { return count_; }
    std::int64_t greatest() const { return greatest_; }  ///< [ns], exact; 0 of none

    /// The time [ns] that the share `part` of all is not above: its bucket's end, at most the
    /// greatest. 0 of none.
    std::int64_t quantile(double part) const;

    struct Bucket {
        std::int64_t below;  ///< [ns]
        std::int64_t count;
    };
    /// By powers of two from the first that is not empty to the last.
    std::vector<Bucket> histogram() const;

  private:
    static constexpr int steps = 32, octaves = 58;  ///< buckets an octave, octaves of 63 bits
    static int bucket_of(std::int64_t nanoseconds);
    static std::int64_t end_of(int bucket);

    std::array<std::int64_t, steps*(octaves + 1)> counts_{};
    std::int64_t count_ = 0, greatest_ = 0;
};

}  // namespace lineshaft

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lineshaft::test {

/// Turns bytes into decisions, so that a fuzzer that changes the bytes changes the decisions. When
/// the bytes are used up every decision is the first one.
class Choices {
  public:
    explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    /// In [0, count). `count` is above 0.
    std::size_t below(std::size_t count) { return byte() % count; }

    /// True once in `times`, on average.
    bool once_in(std::size_t times) { return below(times) == times - 1; }

    template <class Range>
    const auto& one_of(const Range& range) {
        return *(std::begin(range) + static_cast<std::ptrdiff_t>(below(std::size(range))));
    }

  private:
    std::uint8_t byte() {
        if (bytes_.empty()) return 0;
        const std::uint8_t first = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return first;
    }

    std::span<const std::uint8_t> bytes_;
};

}  // namespace lineshaft::test

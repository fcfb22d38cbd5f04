#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>

#include <benchmark/benchmark.h>

namespace lineshaft {

/// The quickest of a benchmark's iterations, which are best short: what the machine does when
/// nothing else runs on it.
class Quickest {
  public:
    template <class Body>
    void time(const Body& body) {
        const auto start = std::chrono::steady_clock::now();
        body();
        const std::chrono::duration<double, std::nano> taken =
            std::chrono::steady_clock::now() - start;
        nanoseconds_ = std::min(nanoseconds_, taken.count());
    }

    /// Counts `what` [ns an item, wall time] of iterations that handle `items` each.
    void count(benchmark::State& state, std::size_t items, const char* what = "least") const {
        state.counters[what] = per(items);
    }
    double per(std::size_t items) const { return nanoseconds_ / static_cast<double>(items); }

  private:
    double nanoseconds_ = std::numeric_limits<double>::infinity();
};

}  // namespace lineshaft

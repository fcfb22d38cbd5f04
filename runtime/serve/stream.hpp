#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/machine/machine.hpp"

namespace lineshaft {

/// Samples of signals on their way to one client: the machine's thread puts a row in after a step,
/// the client's thread takes it out. Neither waits for the other: rows for which there is no room
/// are lost, and counted.
class Stream {
  public:
    static constexpr std::size_t most_bytes = 8 << 20;

    /// A row each `every` [ns] of virtual time, at most one a step.
    Stream(std::vector<const Signal*> signals, std::int64_t every);

    const std::vector<const Signal*>& signals() const { return signals_; }

    /// In the machine's thread.
    void sample(std::int64_t time);

    /// In the client's: the time [ns] and the values of the oldest row, while there is one.
    template <class Take>
    void take(Take row);

    std::int64_t lost() const { return lost_; }  ///< rows so far

    /// The client has gone, or will get no more rows.
    void close() { closed_ = true; }
    bool is_closed() const { return closed_; }

  private:
    std::vector<const Signal*> signals_;
    std::int64_t every_, next_ = 0;  ///< [ns]
    std::size_t row_words_, rows_;
    std::vector<std::uint64_t> words_;
    std::atomic<std::uint64_t> put_ = 0, taken_ = 0;  ///< rows
    std::atomic<std::int64_t> lost_ = 0;
    std::atomic<bool> closed_ = false;
};

template <class Take>
void Stream::take(Take row) {
    const std::uint64_t end = put_.load(std::memory_order_acquire);
    for (std::uint64_t i = taken_.load(std::memory_order_relaxed); i != end; ++i) {
        const std::uint64_t* words = words_.data() + i % rows_ * row_words_;
        row(static_cast<std::int64_t>(words[0]), std::span(words + 1, row_words_ - 1));
        taken_.store(i + 1, std::memory_order_release);
    }
}

}  // namespace lineshaft

#include "runtime/serve/stream.hpp"

#include <algorithm>
#include <cstring>

namespace lineshaft {

Stream::Stream(std::vector<const Signal*> signals, std::int64_t every)
    : signals_(std::move(signals)),
      every_(every),
      row_words_(1 + signals_.size()),
      rows_(std::clamp<std::size_t>(most_bytes / (8 * row_words_), 16, 8192)),
      words_(rows_ * row_words_) {}

void Stream::sample(std::int64_t time) {
    if (time < next_ || closed_) return;
    next_ = time - time % every_ + every_;
    const std::uint64_t row = put_.load(std::memory_order_relaxed);
    if (row - taken_.load(std::memory_order_acquire) == rows_) {
        ++lost_;
        return;
    }
    std::uint64_t* word = words_.data() + row % rows_ * row_words_;
    *word++ = static_cast<std::uint64_t>(time);
    for (const Signal* signal : signals_) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, signal->slot, size_of(signal->type));
        *word++ = bits;
    }
    put_.store(row + 1, std::memory_order_release);
}

}  // namespace lineshaft

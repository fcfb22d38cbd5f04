#include "runtime/debug/history.hpp"

#include <iterator>

namespace lineshaft::debug {

namespace {

std::size_t bytes_of(const History::Checkpoint& checkpoint) {
    return checkpoint.state.size() + checkpoint.hits.size() * 64;
}

}  // namespace

void History::keep(std::int64_t time, Checkpoint checkpoint) {
    const std::size_t bytes = bytes_of(checkpoint);
    if (checkpoints_.emplace(time, std::move(checkpoint)).second) bytes_ += bytes;
    while ((bytes_ > most_bytes || checkpoints_.size() > most) && checkpoints_.size() > 2) thin();
}

/// The one goes whose neighbours are nearest, seen from the present; never the first or the last.
void History::thin() {
    const auto last = std::prev(checkpoints_.end());
    auto dearest = checkpoints_.end();
    double least = 0;
    for (auto it = std::next(checkpoints_.begin()); it != last; ++it) {
        const auto gap = static_cast<double>(std::next(it)->first - std::prev(it)->first);
        const double share = gap / static_cast<double>(last->first - it->first);
        if (dearest != checkpoints_.end() && share >= least) continue;
        dearest = it;
        least = share;
    }
    bytes_ -= bytes_of(dearest->second);
    checkpoints_.erase(dearest);
}

std::pair<std::int64_t, const History::Checkpoint*> History::before(std::int64_t time) const {
    auto it = checkpoints_.lower_bound(time);
    if (it != checkpoints_.begin()) --it;
    return {it->first, &it->second};
}

void History::forget_after(std::int64_t time) {
    for (auto it = checkpoints_.upper_bound(time); it != checkpoints_.end();) {
        bytes_ -= bytes_of(it->second);
        it = checkpoints_.erase(it);
    }
}

}  // namespace lineshaft::debug

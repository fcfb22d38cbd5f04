#include "runtime/machine/replay.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/model/device.hpp"

namespace lineshaft {

std::int64_t Replay::next_time() const {
    if (between_ == Between::interpolated || next_ == points_.size()) return never;
    return std::max(std::int64_t{0}, points_[next_].time);
}

std::optional<Value> Replay::play(std::int64_t now) {
    const std::size_t before = next_;
    while (next_ < points_.size() && points_[next_].time <= now) ++next_;
    if (next_ == 0) return {};
    const std::size_t last = next_ - 1;
    if (between_ == Between::interpolated && next_ < points_.size()) {
        const auto since = [&](std::int64_t t) {
            return static_cast<double>(t - points_[last].time);
        };
        return std::lerp(std::get<double>(value(last)), std::get<double>(value(next_)),
                         since(now) / since(points_[next_].time));
    }
    return next_ == before ? std::nullopt : std::optional(value(last));
}

void Replay::skip_to(std::int64_t now) {
    next_ = static_cast<std::size_t>(std::ranges::upper_bound(points_, now, {}, &Point::time) -
                                     points_.begin());
}

}  // namespace lineshaft

#include "blocks/profile/forecast.hpp"

#include <algorithm>
#include <limits>

#include "blocks/profile/polynomial.hpp"

namespace lineshaft {

void Forecast::add(double begin, const MotionState& start) {
    if (count < most_pieces) pieces[count++] = {begin, start};
}

double Forecast::end(std::size_t piece) const {
    return piece + 1 < count ? pieces[piece + 1].begin : std::numeric_limits<double>::infinity();
}

MotionState Forecast::at(double t) const {
    std::size_t i = 0;
    while (i + 1 < count && t >= end(i)) ++i;
    return pieces[i].start.after(t - pieces[i].begin);
}

double Forecast::time_at(double x, double direction) const {
    for (std::size_t i = known; i < count; ++i) {
        const auto& [begin, s] = pieces[i];
        const Polynomial<3> beyond{{(s.position - x) * direction, s.velocity * direction,
                                    0.5 * s.acceleration * direction, s.jerk * direction / 6}};
        if (beyond.c[0] >= 0) return begin;
        if (i + 1 == count) return beyond.c[1] > 0 ? begin - beyond.c[0] / beyond.c[1] : end(i);
        const auto crossings = zeros(beyond, 0, end(i) - begin);
        if (crossings.count > 0) return begin + crossings.x[0];
    }
    return std::numeric_limits<double>::infinity();
}

bool Forecast::goes_against(double direction, double before) const {
    for (std::size_t i = known; i < count && pieces[i].begin < before; ++i) {
        const MotionState& s = pieces[i].start;
        const double duration = i + 1 < count ? std::min(end(i), before) - pieces[i].begin : 0;
        const Range v = range(Polynomial<2>{{s.velocity * direction, s.acceleration * direction,
                                             0.5 * s.jerk * direction}},
                              0, duration);
        constexpr double of_itself = 0x1p-40;
        if (v.least < -of_itself * v.size()) return true;
    }
    return false;
}

Forecast Forecast::after(double by, const MotionState& before) const {
    if (!(by > 0)) return *this;
    Forecast later;
    MotionState start = before;
    start.jerk = (pieces[0].start.acceleration - before.acceleration) / by;
    later.add(0, start);
    later.known = known + 1;
    for (std::size_t i = 0; i < count; ++i) later.add(by + pieces[i].begin, pieces[i].start);
    return later;
}

}  // namespace lineshaft

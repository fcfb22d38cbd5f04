#include "blocks/path/path_course.hpp"

#include <algorithm>

namespace lineshaft {

void PathCourse::clear() {
    count = 0;
    duration = 0;
    end = {};
}

bool PathCourse::add(const PathPhase& phase, double lasts) {
    if (count == phases.size()) return false;
    phases[count] = phase;
    phases[count].begin = duration;
    ++count;
    duration += lasts;
    end = phase.after(lasts);
    return true;
}

MotionState PathCourse::at(double t) const {
    if (!(t < duration) || count == 0) return end;
    const auto behind =
        std::upper_bound(phases.begin() + 1, phases.begin() + static_cast<std::ptrdiff_t>(count), t,
                         [](double time, const PathPhase& phase) { return time < phase.begin; });
    const PathPhase& phase = *(behind - 1);
    return phase.after(std::max(0.0, t - phase.begin));
}

double PathCourse::time_at(double place) const {
    std::size_t k = 0;
    while (k + 1 < count && phases[k + 1].start.position <= place) ++k;
    const PathPhase& phase = phases[k];
    const double way = place - phase.start.position;
    return phase.begin + (way > 0 ? time_at_way(phase, end_of(k) - phase.begin, way) : 0);
}

}  // namespace lineshaft

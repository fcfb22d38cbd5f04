#include "blocks/motion/seen_motion.hpp"

#include <cmath>

namespace lineshaft {

bool SeenMotion::look(const Axis& seen, MasterValueSource source) {
    const bool is_measured = source == MasterValueSource::actual_value && seen.has_drive;
    if (seen.started == 0 || (count > 0 && seen.scan_time <= end())) return false;
    Sample next{seen.scan_time, seen.actual_position, seen.actual_velocity};
    if (!is_measured) {
        const MotionState state = seen.total();
        next = {seen.scan_time, state.position - seen.relocated, state.velocity};
    }
    if (!std::isfinite(next.place) || !std::isfinite(next.velocity)) return false;
    period = seen.modulo ? seen.period : 0;
    further = is_measured ? 0 : seen.relocated;
    if (is_measured && period > 0 && count > 0)
        next.place += period * std::round((sample().place - next.place) / period);
    newest = count == 0 ? 0 : (newest + 1) % most;
    count = std::min(count + 1, most);
    samples[static_cast<std::size_t>(newest)] = next;
    return true;
}

double SeenMotion::position_at(std::int64_t time) const {
    std::int64_t back = 0;
    while (back + 1 < count && sample(back + 1).time >= time) ++back;
    const Sample& to = sample(back);
    double place = to.place;
    if (back + 1 < count && time < to.time) {
        const Sample& from = sample(back + 1);
        const double part = seconds(to.time - time) / seconds(to.time - from.time);
        place -= part * (to.place - from.place);
    }
    return within_period(place + further, period);
}

void SeenMotion::shift(std::int64_t by) {
    for (Sample& sample : samples) sample.time += by;
}

bool SeenMotion::is_possible(const KeptState& machine) const {
    if (count < 0 || count > most || newest < 0 || newest >= most) return false;
    for (std::int64_t back = 0; back < count; ++back) {
        const Sample& one = sample(back);
        if (!machine.is_moment(one.time) || !std::isfinite(one.place)) return false;
        if (back > 0 && one.time >= sample(back - 1).time) return false;
    }
    return true;
}

}  // namespace lineshaft

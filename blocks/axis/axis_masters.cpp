#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "blocks/axis/axis.hpp"

namespace lineshaft {

namespace {

using Times = std::array<double, Forecast::most_pieces>;

/// Adds when the phases of a plan end that is `passed` old.
void add_ends(const MotionPlan& plan, double passed, Times& times, std::size_t& count) {
    for (std::size_t i = 0; i < plan.count && count < times.size() - 1; ++i) {
        const double end = plan.phases[i].begin + plan.phases[i].duration - passed;
        if (end > 0) times[count++] = end;
    }
}

void add_ends(const VelocityRamp& ramp, double passed, Times& times, std::size_t& count) {
    double end = -passed;
    for (int i = 0; i < ramp.count; ++i) {
        end += ramp.phases[static_cast<std::size_t>(i)].duration;
        if (end > 0) times[count++] = end;
    }
}

}  // namespace

MotionState Axis::led_by(const Context& context, const MasterLink& link) const {
    if (link.axis < 0) return {};
    const Axis& leader = context.seen_instance<Axis>(link.axis);
    const bool measured = link.source == MasterValueSource::actual_value && leader.has_drive;
    MotionState seen =
        measured ? MotionState{leader.actual_position, leader.actual_velocity} : leader.total();
    seen.position -= leader.relocated;
    return seen;
}

/// As the axis sees it.
MotionState Axis::master(const Context& context) const {
    MotionState seen = led_by(context, sync.coupling.master);
    seen.position += sync.shift.position;
    seen.velocity += sync.shift.velocity;
    seen.acceleration += sync.shift.acceleration;
    seen.jerk += sync.shift.jerk;
    return seen;
}

std::int64_t Axis::way_to(const Context& context, const Axis& leader,
                          const Coupling& coupling) const {
    int links_left = 1000;
    return way_to(context, leader, coupling, links_left);
}

std::int64_t Axis::way_to(const Context& context, const Axis& leader) const {
    return doing == Doing::following_axes ? way_to(context, leader, sync.coupling) : nowhere;
}

/// Others may follow each other in a circle until they see it: the search ends all the same.
std::int64_t Axis::way_to(const Context& context, const Axis& leader, const Coupling& coupling,
                          int& links_left) const {
    const auto leads = [&](const Axis& seen) {
        return seen.doing == Doing::following_axes &&
               seen.way_to(context, leader, seen.sync.coupling, links_left) >= 0;
    };
    for (const MasterLink* link : {&coupling.master, &coupling.second}) {
        if (link->axis < 0) continue;
        if (--links_left < 0) return nowhere;
        if (&context.instance<Axis>(link->axis) == &leader ||
            leads(context.seen_instance<Axis>(link->axis)))
            return link->axis;
    }
    return nowhere;
}

/// Siemens' ratios are two DINT, the denominator above 0.
bool Axis::admits(const MasterLink& link) const {
    if (profile == AxisProfile::plcopen) return link.denominator != 0;
    const auto is_dint = [](double x) {
        return std::trunc(x) == x && std::abs(x) <= std::numeric_limits<std::int32_t>::max();
    };
    return is_dint(link.numerator) && is_dint(link.denominator) && link.numerator != 0 &&
           link.denominator > 0;
}

MotionError Axis::check_masters(const Context& context, const Coupling& c) const {
    if (c.master.axis < 0) return MotionError::no_master;
    if (!admits(c.master) || !admits(c.second) || c.master_scaling == 0 || c.start_distance < 0)
        return MotionError::out_of_range;
    return way_to(context, *this, c) >= 0 ? MotionError::master_loop : MotionError::none;
}

// What is foreseen.

/// Where a motion is that the axis has planned itself, t seconds after its scan.
MotionState Axis::planned(double t) const {
    MotionState s = doing == Doing::moving_to_point
                        ? point_motion.plan.at(point_motion.start.until(scan_time) + t)
                        : velocity_motion.later(velocity_motion.start.until(scan_time) + t);
    const MotionState more = added.exists() && added_paused == 0
                                 ? added_motion.plan.at(added_motion.start.until(scan_time) + t)
                                 : extra;
    return {s.position + offset + more.position, s.velocity + more.velocity,
            s.acceleration + more.acceleration, s.jerk + more.jerk};
}

/// A master that is measured, led by set-points, or scanned less often than its slave, moves in
/// jumps.
bool Axis::is_steady(const Context& context) const {
    const Axis& leader = context.seen_instance<Axis>(sync.coupling.master.axis);
    return !sync.coupling.is_measured() && leader.doing != Doing::following_set_points &&
           leader.scan_interval <= scan_interval;
}

/// The master as the axis sees it, from now on: as it has planned it itself; one that follows
/// others keeps its jerk for two scans, and then its velocity.
Forecast Axis::foresee(const Context& context) const {
    const Axis& leader = context.seen_instance<Axis>(sync.coupling.master.axis);
    const MotionState now = master(context);
    Forecast ahead;
    ahead.add(0, now);
    const bool plans = leader.doing == Doing::holding || leader.doing == Doing::moving_to_point ||
                       leader.doing == Doing::following_velocity;
    if (sync.coupling.is_measured() || !plans || leader.goes_by_way()) {
        if (now.acceleration == 0 && now.jerk == 0) return ahead;
        const double soon = 2 * seconds(scan_interval);
        const MotionState then = now.after(soon);
        ahead.add(soon, {then.position, then.velocity, 0, 0});
        return ahead;
    }
    Times times{};
    std::size_t count = 0;
    if (leader.doing == Doing::moving_to_point)
        add_ends(leader.point_motion.plan, leader.point_motion.start.until(leader.scan_time), times,
                 count);
    else
        add_ends(leader.velocity_motion.ramp, leader.velocity_motion.start.until(leader.scan_time),
                 times, count);
    if (leader.added.exists())
        add_ends(leader.added_motion.plan, leader.added_motion.start.until(leader.scan_time), times,
                 count);
    if (phased.exists())
        add_ends(sync.shifting.plan, sync.shifting.start.until(scan_time), times, count);
    std::ranges::sort(std::span(times).first(count));
    const auto seen_at = [&](double t) {
        MotionState s = leader.planned(t);
        s.position -= leader.relocated;
        const MotionState by = phased.exists()
                                   ? sync.shifting.plan.at(sync.shifting.start.until(scan_time) + t)
                                   : MotionState{sync.shift.position};
        return MotionState{s.position + by.position, s.velocity + by.velocity,
                           s.acceleration + by.acceleration, s.jerk + by.jerk};
    };
    double begin = 0;
    for (std::size_t i = 0; i <= count; ++i) {
        const double end = i < count ? times[i] : begin + 1;
        if (!(end > begin)) continue;
        MotionState start = begin == 0 ? now : seen_at(begin);
        start.jerk = seen_at(0.5 * (begin + end)).jerk;
        if (i == count) start.acceleration = start.jerk = 0;
        if (begin == 0)
            ahead.pieces[0].start = start;
        else
            ahead.add(begin, start);
        begin = end;
    }
    return ahead;
}

}  // namespace lineshaft

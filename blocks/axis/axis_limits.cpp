#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks/axis/axis.hpp"
#include "blocks/axis/way.hpp"
#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

/// How far sums as 0.1 + 0.2 may be off: a billionth of the unit, or of a shorter way between the
/// limits, and what rounding does to the limit itself.
double tolerance_of(double limit, double size) {
    constexpr double part = 1e-9, rounding = 8 * std::numeric_limits<double>::epsilon();
    return part * std::min(1.0, size) + rounding * std::abs(limit);
}

/// More than an axis needs from v and a to rest: jerk and deceleration one after the other, each
/// at the greatest speed.
double longest_stop(const MotionState& from, const Dynamics& d) {
    const double a = std::abs(from.acceleration), per_jerk = 1 / d.jerk;
    const double least = std::min(d.acceleration, d.deceleration);
    const double speed = std::abs(from.velocity) + 0.5 * a * a * per_jerk;
    return speed * ((a + d.acceleration + d.deceleration) * per_jerk + speed / least);
}

}  // namespace

bool Axis::Bounds::contain(const Range& positions) const {
    return positions.least >= lowest - below && positions.greatest <= highest + above;
}

/// An axis that is outside may come in: what it has shown last is a limit then.
Axis::Bounds Axis::bounds() const {
    const double size = std::abs(highest_position - lowest_position);
    const double here = shown.state.position + (relocated - shown.relocated);
    const bool is_low = !(here >= lowest_position), is_high = !(here <= highest_position);
    return {is_low ? here : lowest_position, is_high ? here : highest_position,
            tolerance_of(lowest_position, size), tolerance_of(highest_position, size)};
}

bool Axis::Bounds::admit(double& place) const {
    if (!contain({place, place})) return false;
    place = std::clamp(place, lowest, highest);
    return true;
}

/// With the defaults, from there.
bool Axis::can_brake(const MotionState& from) const {
    VelocityMotion stop;
    if (stop.begin(from, 0, defaults(), {}) != PlanResult::ok) return false;
    Way way({});
    way.add(stop);
    return bounds().contain(way.positions(way.duration()));
}

/// From where the way ends, too, it can brake inside.
bool Axis::leads_inside(const Way& way, const Range& further) const {
    Range passed = way.positions(way.duration());
    passed = {passed.least + further.least, passed.greatest + further.greatest};
    MotionState end = way.at(way.duration());
    end.position += further.least;
    const bool is_known = further.least == further.greatest;
    return bounds().contain(passed) && (end.velocity == 0 || (is_known && can_brake(end)));
}

/// With what is on top of it, as both are planned.
template <class Motion>
bool Axis::leads_inside(const Motion& beneath, const Start& from) const {
    Way way(beneath.start);
    way.add(beneath);
    const bool adds = added.exists() && !from.drops_added;
    if (adds && !goes_by_way()) way.add(added_motion);
    Range further = from.drops_added ? Range{extra.position, extra.position} : added_range();
    further.least -= from.taken;
    further.greatest -= from.taken;
    return leads_inside(way, further);
}

/// Where what is on top may be, but for what is planned over time, as the way has that.
Range Axis::added_range() const {
    if (!added.exists()) return {extra.position, extra.position};
    if (!goes_by_way()) return {};
    const MotionState s = added_motion.plan.at(added_passed);
    const double stop = stopping_position(s, asked_of(added.request));
    return {std::min({s.position, added_goal, stop}), std::max({s.position, added_goal, stop})};
}

/// The motion under way, as it is planned, from the scan under way on.
bool Axis::goes_on_inside() const {
    if (doing == Doing::following_axes || doing == Doing::following_profile || is_led())
        return false;
    Way way({scan_time});
    if (doing == Doing::moving_to_point)
        way.add(point_motion);
    else
        way.add(velocity_motion);
    const bool over_time = added.exists() && !goes_by_way();
    if (over_time) way.add(added_motion);
    Range further = added_range();
    further.least += offset;
    further.greatest += offset;
    if (leg.exists == 0) return leads_inside(way, further);
    const Moment end = point_motion.start.after(point_motion.plan.duration);
    const Range passed = way.positions(std::max(0.0, -end.until(scan_time)));
    if (!bounds().contain({passed.least + further.least, passed.greatest + further.greatest}))
        return false;
    PointMotion rest;
    if (rest.begin(point_motion.plan.end, leg.goal, leg.velocity, leg.dynamics, end) !=
        PlanResult::ok)
        return false;
    Way then(end);
    then.add(rest);
    if (over_time) then.add(added_motion);
    return leads_inside(then, further);
}

/// A law or a table that turns inside may come so near to a limit that only a jump of the
/// deceleration could stop it.
bool Axis::turns_inside(const MotionState& from) const {
    if (doing != Doing::following_axes && doing != Doing::following_profile) return false;
    if (from.velocity * from.acceleration >= 0) return false;
    const double way = from.velocity * std::abs(from.velocity) / (2 * default_deceleration);
    return bounds().contain({std::min(from.position, from.position + way),
                             std::max(from.position, from.position + way)});
}

bool Axis::Safe::contains(const MotionState& at) const {
    return lowest <= at.position && at.position <= highest && std::abs(at.velocity) <= speed &&
           std::abs(at.acceleration) <= acceleration;
}

/// Around a state from which the axis can brake wherever it goes: those that come next need no look
/// of their own then. False where the state itself lies elsewhere.
bool Axis::finds_room(const MotionState& next) {
    const Dynamics d = defaults();
    MotionState worst;
    worst.velocity = std::max(std::abs(next.velocity), d.velocity);
    worst.acceleration = std::max({std::abs(next.acceleration), d.acceleration, d.deceleration});
    const double far = longest_stop(worst, d);
    safe.lowest = lowest_position + far;
    safe.highest = highest_position - far;
    safe.speed = worst.velocity;
    safe.acceleration = worst.acceleration;
    return safe.contains(next);
}

/// What is shown is at each time a state from which the axis can stop inside its limits: with its
/// defaults, or by going on as planned. One that is inside and goes on to an end stays so.
bool Axis::is_safe(const MotionState& next) {
    if (is_led()) return bounds().contain({next.position, next.position});
    if (safe.contains(next)) return true;
    const Bounds kept = bounds();
    const bool is_inside = kept.lowest == lowest_position && kept.highest == highest_position;
    const bool has_end = doing != Doing::holding || base.velocity == 0;
    if (is_inside && has_end && goes_on_inside()) safe.as_planned = 1;
    if (safe.as_planned != 0 || finds_room(next)) return true;
    const double far = longest_stop(next, defaults());
    return kept.contain({next.position - far, next.position + far}) || can_brake(next) ||
           goes_on_inside() || turns_inside(next);
}

/// From when on limits count: they may be written at any time.
void Axis::watch_limits() {
    if (!software_limits)
        shown.exists = 0;
    else if (shown.exists == 0)
        show();
}

/// Where the set-point of a scan would not be safe it is dropped, and the axis stops from the one
/// of before, which was.
void Axis::keep_limits(const Context& context) {
    if (safe.as_planned != 0) return show();
    if (const MotionState next = total(); !is_safe(next)) {
        const bool finite = all_finite(next.position, next.velocity, next.acceleration, next.jerk);
        stop_inside(context, finite ? MotionError::software_limit : MotionError::not_finite);
    }
    show();
}

void Axis::show() {
    MotionState next = total();
    const bool is_inside = lowest_position <= next.position && next.position <= highest_position;
    if (!is_inside && shown.exists != 0) bounds().admit(next.position);
    shown = {1, next, scan_time, relocated};
}

void Axis::stop_inside(const Context& context, MotionError why) {
    const Moment at{shown.time};
    MotionState from = shown.state;
    from.position += relocated - shown.relocated;
    if (added.exists()) look_at_added(shown.time);
    const auto restart = [&] {
        base = from;
        offset = 0;
        clear_added();
    };
    restart();
    const bool can = can_brake(from);
    if (state == AxisState::error_stop)
        brake(at);
    else
        fail(context, at, why);
    if (!can) {
        restart();
        stop_at_limit(at);
    }
    if (doing == Doing::holding) come_to_rest(context);
    advance(context, scan_time);
}

/// The position wins over jerk, and over deceleration where the default is too weak.
void Axis::stop_at_limit(const Moment& at) {
    const MotionState from = base;
    const Bounds kept = bounds();
    const double way = 0.5 * from.velocity * std::abs(from.velocity) / default_deceleration;
    const double stop = std::clamp(from.position + way, kept.lowest, kept.highest);
    if (!velocity_motion.stand_at(stop, from, at)) return hold({from.position}, at);
    doing = Doing::following_velocity;
}

/// A goal within the tolerance is put onto its limit.
bool Axis::may_aim_at(double& to, const Start& from) const {
    if (!software_limits) return true;
    const double further = from.drops_added ? 0 : added_goal - from.taken;
    const double end = to + further;
    double admitted = end;
    if (!bounds().admit(admitted)) return false;
    if (admitted != end) to = admitted - further;
    return true;
}

/// Whether a motion that is about to begin stays inside.
bool Axis::may_begin(const PointMotion& next, const Start& from) const {
    return !software_limits || leads_inside(next, from);
}

/// A motion to a velocity has no end: it is left to run where the axis can brake.
bool Axis::may_begin(const VelocityMotion& next, const Start& from) const {
    return !software_limits || leads_inside(next, from) || can_brake(total());
}

/// The whole table stays inside, with what is on top where that stays.
bool Axis::may_follow(const ProfileMotion& next, const Cam& cam, const Start& from) const {
    if (!software_limits) return true;
    const double further = from.drops_added ? 0 : added_goal - from.taken;
    const Range way = next.positions(cam);
    return bounds().contain({way.least + further, way.greatest + further});
}

/// A command that waits is refused at once where it is known that its goal lies outside.
bool Axis::may_wait(const Context& context, const Request& request) const {
    using enum Command;
    if (!software_limits) return true;
    Start there;
    bool is_known = doing == Doing::moving_to_point && !added.exists() && lasting == 0;
    there.state.position = there.origin = goal + added_goal;
    there.taken = added_goal;
    const auto go_on = [&](const Request& next) {
        const bool has_target = is_absolute(next.command) &&
                                (next.command != home || next.homing == HomingMode::to_position);
        const bool is_relative = next.command == move_relative || next.command == move_additive ||
                                 next.command == move_continuous_relative;
        is_known = has_target || (is_relative && is_known);
        if (is_known) there.state.position = there.origin = target_of(next, there);
    };
    for (std::int64_t at = queue.first; at != nowhere; at = context.at<Job>(at).next)
        go_on(context.at<Job>(at).request);
    go_on(request);
    return !is_known || bounds().admit(there.origin);
}

/// On top of what the axis does.
bool Axis::may_add(const PointMotion& next, bool by_way) const {
    if (!software_limits) return true;
    const bool ends = doing == Doing::moving_to_point ||
                      (doing != Doing::following_axes && doing != Doing::following_profile &&
                       !is_led() && velocity_motion.ramp.end.velocity == 0);
    if (!ends) return true;
    Way way(next.start);
    if (doing == Doing::moving_to_point)
        way.add(point_motion);
    else
        way.add(velocity_motion);
    if (!by_way) way.add(next);
    Way alone(next.start);
    if (by_way) alone.add(next);
    const Range more = alone.positions(alone.duration());
    return leads_inside(way, {offset + more.least, offset + more.greatest});
}

}  // namespace lineshaft

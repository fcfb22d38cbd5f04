#include "blocks/motion/switched_cam.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blocks/axis/axis.hpp"

namespace lineshaft {

namespace {

constexpr double not_passed = std::numeric_limits<double>::infinity();

/// From -period / 2 to period / 2; without a period as it is.
double nearest(double x, double period) {
    return period > 0 ? x - period * std::round(x / period) : x;
}

std::int64_t in_nanoseconds(double seconds) {
    constexpr double most = 1e9;
    return std::llround(std::clamp(seconds, -most, most) * 1e9);
}

}  // namespace

Stretch Stretch::last_turn() const {
    const double turns = period > 0 ? std::abs(last - first) / period : 0;
    if (!(turns > 1)) return *this;
    Stretch turn = *this;
    turn.first = last - std::copysign(period, last - first);
    turn.begin = end - std::llround(static_cast<double>(end - begin) / turns);
    return turn;
}

std::int64_t Stretch::time_at(double part) const {
    return begin + std::llround(part * static_cast<double>(end - begin));
}

void SwitchChanges::add(std::int64_t time, bool on) {
    if (count < all.size()) all[count++] = {time, on};
}

/// How far the axis is beyond an edge, at the beginning and at the end of a stretch.
struct SwitchedCam::Beyond {
    double first = 0, last = 0;

    double way() const { return last - first; }
    /// Where something that lies so far ahead on the way is, as a part of it.
    double part_of(double ahead) const { return way() == 0 ? 0 : ahead / std::abs(way()); }
    double at(double part) const { return first + part * way(); }

    /// When the edge is passed, as a part of the way. Its own place belongs to the cam: an axis
    /// that comes to it has passed it, one that leaves it has when it goes on.
    double passing(bool into_cam, double period) const {
        if (way() == 0) return not_passed;
        double ahead = way() > 0 ? -first : first;
        if (period > 0) {
            ahead = std::fmod(ahead, period);
            if (ahead < 0 || (ahead == 0 && into_cam)) ahead += period;
        }
        const bool is_there = into_cam ? ahead > 0 && ahead <= std::abs(way())
                                       : ahead >= 0 && ahead < std::abs(way());
        return is_there ? part_of(ahead) : not_passed;
    }

    /// When an edge that holds lets go.
    double release(double hysteresis, double period) const {
        const double from = nearest(first, period);
        const double ahead = way() > 0 ? hysteresis - from : hysteresis + from;
        if (std::abs(from) > hysteresis) return 0;
        return ahead < std::abs(way()) ? part_of(ahead) : not_passed;
    }
};

/// Both edges of a cam in a stretch. `last` is where the axis leaves the cam forward.
struct SwitchedCam::Edges {
    Beyond first, last;
    double period = 0, hysteresis = 0;
    bool is_inverted = false;  ///< on outside of both

    Edges(const SwitchCam& cam, const SwitchTrack& track, const Stretch& way) {
        const bool is_turned = cam.last < cam.first;
        const double end = cam.last + (is_turned ? way.period : 0);
        const auto beyond = [&](double place, double edge, double v, double later) {
            return place + way.further - (edge + v * later);
        };
        const auto first_at = [&](double place, double v) {
            return beyond(place, cam.first, v,
                          v < 0 && cam.mode == SwitchMode::position ? track.off_compensation
                                                                    : track.on_compensation);
        };
        const auto last_at = [&](double place, double v) {
            return beyond(place, end, v, v < 0 ? track.on_compensation : track.off_compensation);
        };
        first = {first_at(way.first, way.first_velocity), first_at(way.last, way.last_velocity)};
        last = {last_at(way.first, way.first_velocity), last_at(way.last, way.last_velocity)};
        period = way.period;
        hysteresis = track.hysteresis;
        is_inverted = is_turned && !(period > 0);
    }

    bool contain(double part) const {
        const double x = first.at(part), y = last.at(part);
        if (is_inverted) return x >= 0 || y <= 0;
        if (!(period > 0)) return x >= 0 && y <= 0;
        const double length = x - y;
        return length >= 0 && within_period(x, period) <= length;
    }

    /// Whether the axis is inside when it has just passed the first or the last edge.
    bool contain_after(bool of_first, bool into_cam, double part) const {
        const double x = first.at(part), y = last.at(part);
        const bool beside_other = of_first ? y <= 0 : x >= 0;
        if (period > 0) return into_cam ? x - y >= 0 : x - y >= period;
        return is_inverted ? into_cam || beside_other : into_cam && beside_other;
    }
};

void SwitchedCam::set(bool wanted, std::int64_t time, SwitchChanges& changes) {
    if (wanted != on) changes.add(time, wanted);
    on = wanted;
}

void SwitchedCam::begin(const SwitchCam& cam, const SwitchTrack& track, const Stretch& at_end) {
    *this = {};
    if (cam.mode == SwitchMode::position) inside = Edges(cam, track, at_end).contain(1);
    on = inside && cam.direction == SwitchDirection::both;
}

void SwitchedCam::pass(const SwitchCam& cam, const SwitchTrack& track, const Stretch& way,
                       SwitchChanges& changes) {
    if (way.last != way.first) forward = way.last > way.first;
    const Edges edges(cam, track, way);
    if (cam.mode == SwitchMode::time) return pass_trigger(cam, track, edges, way, changes);
    const bool counts = cam.direction == SwitchDirection::both ||
                        (cam.direction == SwitchDirection::positive) == forward;
    pass_edges(edges, way, counts, changes);
}

/// From one event to the next: an edge is passed, or lets go.
void SwitchedCam::pass_edges(const Edges& edges, const Stretch& way, bool counts,
                             SwitchChanges& changes) {
    set(inside && counts, way.begin, changes);
    const bool up = edges.first.way() > 0, last_up = edges.last.way() > 0;
    const double h = edges.hysteresis, period = edges.period;
    struct Event {
        double part;
        bool* holds;
        const Beyond* edge;
        bool passes, into_cam;
    };
    Event events[] = {
        {edges.first.passing(up, period), &first_holds, &edges.first, true, up},
        {edges.last.passing(!last_up, period), &last_holds, &edges.last, true, !last_up},
        {first_holds ? edges.first.release(h, period) : not_passed, &first_holds, &edges.first,
         false, false},
        {last_holds ? edges.last.release(h, period) : not_passed, &last_holds, &edges.last, false,
         false}};
    for (int i = 0; i < 6; ++i) {
        Event& next = *std::ranges::min_element(events, {}, &Event::part);
        if (next.part == not_passed) break;
        const double part = next.part;
        next.part = not_passed;
        if (next.passes && *next.holds) continue;
        if (next.passes) {
            inside = edges.contain_after(next.edge == &edges.first, next.into_cam, part);
            *next.holds = h > 0;
            const double freed = part + next.edge->part_of(h);
            if (h > 0)
                events[next.holds == &first_holds ? 2 : 3].part = freed < 1 ? freed : not_passed;
        } else {
            *next.holds = false;
            inside = edges.contain(part);
        }
        set(inside && counts, way.time_at(part), changes);
    }
    if (!first_holds && !last_holds) inside = edges.contain(1);
    set(inside && counts, way.end, changes);
}

/// A time cam begins anew each time that its first position is passed.
void SwitchedCam::pass_trigger(const SwitchCam& cam, const SwitchTrack& track, const Edges& edges,
                               const Stretch& way, SwitchChanges& changes) {
    const bool up = edges.first.way() > 0;
    if (first_holds && edges.first.release(edges.hysteresis, edges.period) != not_passed)
        first_holds = false;
    const double part = edges.first.passing(true, edges.period);
    const bool counts = cam.direction == SwitchDirection::both ||
                        (cam.direction == SwitchDirection::positive) == up;
    if (part == not_passed || first_holds) return;
    first_holds = edges.hysteresis > 0;
    if (!counts) return;
    const std::int64_t time = way.time_at(part);
    expire(time, changes);
    until = time + in_nanoseconds(cam.duration + track.off_compensation - track.on_compensation);
    if (until > time) set(true, time, changes);
}

void SwitchedCam::expire(std::int64_t now, SwitchChanges& changes) {
    if (on && until <= now) set(false, until, changes);
}

}  // namespace lineshaft

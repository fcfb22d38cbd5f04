#include "blocks/path/path_ahead.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "blocks/path/path_limits_kept.hpp"
#include "blocks/path/path_mesh.hpp"
#include "blocks/path/path_optimum.hpp"

namespace lineshaft {

namespace {

ConstPathStretches from_stretch(const ConstPathStretches& stretches, std::uint64_t number) {
    return {stretches.ring, number, stretches.count};
}

PathPieces from_place(const PathPieces& pieces, double place) {
    PathPieces out = pieces;
    while (out.first + 1 < out.count && out[out.first].end() <= place) ++out.first;
    return out;
}

/// Legs behind each other, up to a number of intervals.
struct Chain {
    PathCourse course;
    double base = 0, end = 0;  ///< along the path [u]
    std::uint64_t goal = 0;
    MeshNeed need;
    bool is_curved = false, has_spline = false;

    bool add(const PathLeg& leg, double since);
    std::size_t add(const PathOutlook& outlook, const PathPieces& pieces, const PathLeg& first,
                    double since, std::size_t most);
    bool has_room(const PathPieces& pieces, double to);
    bool is_quick() const;
};

bool Chain::add(const PathLeg& leg, double since) {
    const double offset = leg.base - base;
    bool all = true;
    const auto append = [&](PathPhase phase, double begin, double until) {
        if (until <= since) return;
        const double skipped = std::max(0.0, since - begin);
        phase.start = phase.after(skipped);
        phase.start.position += offset;
        all = all && course.add(phase, until - begin - skipped);
    };
    for (std::size_t i = 0; i < leg.course.count; ++i)
        append(leg.course.phases[i], leg.course.phases[i].begin, leg.course.end_of(i));
    for (std::size_t i = 0; i < leg.plan.count && leg.course.count == 0; ++i) {
        const MotionPlan::Phase& phase = leg.plan.phases[i];
        append({0, phase.start, 0}, phase.begin, phase.begin + phase.duration);
    }
    end = leg.end;
    goal = leg.goal;
    course.end = {end - base, leg.end_velocity(), 0, 0};
    return all;
}

/// What is left of a leg and those that follow it, up to so many. How many; 0 where there is no
/// room.
std::size_t Chain::add(const PathOutlook& outlook, const PathPieces& pieces, const PathLeg& first,
                       double since, std::size_t most) {
    if (!has_room(pieces, first.end) || !add(first, since)) return 0;
    constexpr double enough = 0.3 * most_speed_intervals;
    std::size_t legs = 1;
    for (PathLeg next; legs < most && course.end.velocity > 0 && !outlook.stretches.is_last(goal);
         ++legs) {
        if (!plan_leg(from_stretch(outlook.stretches, goal + 1), {0, course.end.velocity, 0, 0},
                      end, outlook.factor, outlook.halt, next) ||
            !has_room(pieces, next.end) || course.count + next.plan.count > PathCourse::most_phases)
            break;
        add(next, 0);
        if (need.intervals >= enough && is_quick()) break;
    }
    return legs;
}

/// There is room for the pieces behind `end` up to a place.
bool Chain::has_room(const PathPieces& pieces, double to) {
    constexpr double most_intervals = 0.6 * most_speed_intervals;
    constexpr double most_rows = 0.7 * SpeedProblem::most_rows;
    for (PathPieces on = from_place(pieces, end); on.first < on.count; ++on.first) {
        const PathPiece& piece = on[on.first];
        if (piece.begin >= to) break;
        const MeshNeed of = mesh_need(piece);
        need.intervals += of.intervals;
        need.rows += 1.3 * of.intervals * of.rows;
        is_curved = is_curved || piece.curve.kind != PathCurveKind::line;
        has_spline = has_spline || piece.curve.kind == PathCurveKind::spline;
    }
    return need.intervals <= most_intervals && need.rows <= most_rows;
}

/// What is saved of so short intervals takes as long to be found (README.md, "The least time").
/// Boxes of splines leave more.
bool Chain::is_quick() const {
    constexpr double least_duration = 5e-3;  ///< of an interval [s]
    return !has_spline && course.duration < least_duration * need.intervals;
}

bool is_straight(const PathPieces& pieces, double to) {
    for (PathPieces on = pieces; on.first < on.count && on[on.first].begin < to; ++on.first)
        if (on[on.first].curve.kind != PathCurveKind::line) return false;
    return true;
}

/// When it begins to come down to its end.
double ripe_at(const PathCourse& course) {
    std::size_t i = course.count;
    const auto comes_down = [](const PathPhase& phase) {
        return phase.start.acceleration < 0 || phase.start.jerk < 0 || phase.slope < 0;
    };
    while (i > 0 && comes_down(course.phases[i - 1])) --i;
    return i < course.count ? course.phases[i].begin : course.duration;
}

bool is_given(double halt) {
    return halt < no_path_limit.acceleration;
}

/// Along the path, with the acceleration and jerk of a halt.
PathLimit braking_limit(PathLimit path, const PathLimit& halt) {
    if (is_given(halt.acceleration)) path.acceleration = halt.acceleration;
    if (is_given(halt.jerk)) path.jerk = halt.jerk;
    return path;
}

/// The least that pieces on a way leave along their tangents.
PathLimit least_on_way(const PathOutlook& outlook, double from, double to,
                       const PathLimit& halt = no_path_limit) {
    PathLimit out = no_path_limit;
    for (PathPieces on = from_place(outlook.pieces, from); on.first < on.count; ++on.first) {
        const PathPiece& piece = on[on.first];
        if (piece.begin >= to) break;
        out = least_of(out, braking_limit(piece.limits.path, halt));
        for (std::size_t i = 0; i < most_path_axes; ++i) {
            const double share = piece.bounds[i].tangent;
            const PathLimit& axis = piece.limits.axes[i];
            if (share > 0)
                out = least_of(
                    out, {axis.velocity / share, axis.acceleration / share, axis.jerk / share});
        }
    }
    return out;
}

/// The stretch in which a place lies; the last one also for what is behind it.
std::uint64_t stretch_at(const ConstPathStretches& stretches, double place) {
    std::uint64_t k = stretches.first;
    while (!stretches.is_last(k) && stretches[k].end < place) ++k;
    return k;
}

/// A ramp to a velocity, and what goes on from there.
bool try_ramp(const PathOutlook& outlook, const MotionState& from, double base, double velocity,
              const PathLimit& limit, PathLeg& out, const PathLimit* braking = nullptr) {
    VelocityRamp ramp;
    if (ramp.plan(from.velocity, from.acceleration, velocity, limit.acceleration, limit.jerk) !=
        PlanResult::ok)
        return false;
    const double end = base + ramp.end.position;
    const std::uint64_t goal = stretch_at(outlook.stretches, end);
    if (!(end <= outlook.stretches[goal].end) || outlook.stretches.passes_stop(goal)) return false;
    PathLeg leg;
    leg.base = base;
    for (int i = 0; i < ramp.count; ++i) {
        const auto& phase = ramp.phases[static_cast<std::size_t>(i)];
        leg.course.add({0, phase.start, 0}, phase.duration);
    }
    leg.course.end = {ramp.end.position, velocity, 0, 0};
    leg.end = end;
    leg.goal = goal;
    std::array<double, PathCourse::most_phases> quotients{};
    if (leg.course.count == 0 ||
        !keeps_limits(from_place(outlook.pieces, base), leg.course, base, quotients, braking))
        return false;
    if (velocity > 0) {
        Chain chain;
        PathLeg next;
        chain.base = base;
        if (!plan_leg(from_stretch(outlook.stretches, goal), {0, velocity, 0, 0}, end,
                      outlook.factor, outlook.halt, next) ||
            !chain.add(leg, 0) || !chain.add(next, 0))
            return false;
        leg.course = chain.course;
        leg.end = chain.end;
        leg.goal = chain.goal;
    }
    leg.ripe = leg.course.duration;
    out = leg;
    return true;
}

}  // namespace

bool look_ahead(const PathOutlook& outlook, double since, PathLeg& leg, PathVain& vain) {
    constexpr double worth = 0.998;
    constexpr std::size_t fewest = 2;
    const double base = leg.base + leg.at(since).position;
    const PathPieces pieces = from_place(outlook.pieces, base);
    const double reach = since > 0 ? base : leg.end;
    if (reach <= vain.until || (leg.end_velocity() == 0 && is_straight(pieces, leg.end)))
        return false;
    for (std::size_t legs = vain.legs;; legs /= 2) {
        Chain chain;
        chain.base = chain.end = base;
        legs = chain.add(outlook, pieces, leg, since, legs);
        if (legs == 0 || !chain.is_curved) return false;
        if (chain.is_quick()) {
            vain.until = chain.end + 3 * (chain.end - base);
            return false;
        }
        PathCourse found;
        const bool is_found = find_optimum(pieces, chain.course, base, outlook.factor, found);
        if (is_found && found.duration <= worth * chain.course.duration) {
            leg.plan = {};
            leg.course = found;
            leg.base = base;
            leg.end = chain.end;
            leg.goal = chain.goal;
            leg.ripe = ripe_at(found);
            vain.legs = std::max(2 * legs, fewest);
            return true;
        }
        if (is_found && since > 0) {
            constexpr double little = 0.125;
            vain.until = base + little * (chain.end - base);
            return false;
        }
        if (is_found || legs <= fewest) {
            vain = {0.5 * (base + chain.end), std::max(legs / 2, fewest)};
            return false;
        }
    }
}

IntoBoxes plan_into_boxes(const PathOutlook& outlook, const MotionState& from, double base,
                          PathLeg& out) {
    const ConstPathStretches& stretches = outlook.stretches;
    const double stop = way_to(from, 0, least_on_way(outlook, base, base));
    const PathLimit all = least_on_way(outlook, base, base + (std::isfinite(stop) ? stop : 0));
    for (const double part : {1.0, 0.6, 0.35, 0.2, 0.1}) {
        const IntoBoxes found = part == 1 ? IntoBoxes::soon : IntoBoxes::late;
        const PathLimit limit{all.velocity, part * all.acceleration, part * all.jerk};
        const auto ends_with = [&](double velocity, const PathLimit& gently) {
            return try_ramp(outlook, from, base, velocity, least_of(limit, gently), out);
        };
        if (outlook.factor == 0) {
            if (ends_with(0, outlook.halt) || ends_with(0, no_path_limit)) return found;
            continue;
        }
        double slowest = stretches[stretches.first].box.velocity;
        const std::uint64_t last = stretch_at(stretches, base + way_to(from, 0, limit));
        for (std::uint64_t k = stretches.first; k <= last; ++k)
            slowest = std::min(slowest, stretches[k].box.velocity);
        for (const double share : {1.0, 0.5, 0.0})
            if (ends_with(share * outlook.factor * slowest, no_path_limit)) return found;
    }
    return IntoBoxes::none;
}

IntoBoxes plan_harder_halt(const PathOutlook& outlook, const MotionState& from, double base,
                           double within, PathLeg& out) {
    const PathLimit braking = braking_limit({0, 0, 0}, outlook.halt);
    const double stop = way_to(from, 0, least_on_way(outlook, base, base, outlook.halt));
    const double to = base + (std::isfinite(stop) ? stop : 0);
    const PathLimit all = least_on_way(outlook, base, to, outlook.halt);
    for (const double part : {1.0, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1}) {
        PathLeg leg;
        const PathLimit limit{all.velocity, part * all.acceleration, part * all.jerk};
        if (!try_ramp(outlook, from, base, 0, limit, leg, &braking)) continue;
        if (!(leg.duration() < within)) return IntoBoxes::none;
        out = leg;
        return part == 1 ? IntoBoxes::soon : IntoBoxes::late;
    }
    return IntoBoxes::none;
}

}  // namespace lineshaft

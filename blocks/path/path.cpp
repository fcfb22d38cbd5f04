#include "blocks/path/path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <sleef.h>

#include "blocks/profile/seven_segment.hpp"

namespace lineshaft {

namespace {

PathPiece& piece_at(std::span<PathPiece> ring, std::uint64_t number) {
    return ring[number % ring.size()];
}

const PathPiece& piece_at(std::span<const PathPiece> ring, std::uint64_t number) {
    return ring[number % ring.size()];
}

bool good(double limit) {
    return std::isfinite(limit) && limit > 0;
}

bool good(const PathLimit& limit) {
    return good(limit.velocity) && good(limit.acceleration) && good(limit.jerk);
}

/// What the axes allow along the tangent alone: the least quotient of limit and share.
PathLimit tangential(const PathCurve& curve, const PathLimits& limits) {
    constexpr double none = std::numeric_limits<double>::infinity();
    PathLimit least{none, none, none};
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const double share = curve.share(i);
        if (share == 0) continue;
        least.velocity = std::min(least.velocity, limits.axes[i].velocity / share);
        least.acceleration = std::min(least.acceleration, limits.axes[i].acceleration / share);
        least.jerk = std::min(least.jerk, limits.axes[i].jerk / share);
    }
    return least;
}

/// Greatest sizes of an axis' first three derivatives by s in a corner, or of the whole vector's;
/// its limit.
struct CornerBound {
    double tangent = 0, bend = 0, twist = 0;
    PathLimit limit;
};

/// Parts of a limit that the curvature alone may take, and the product of speed and acceleration: a
/// corner is passed at nearly one speed.
constexpr double of_acceleration = 0.9, of_jerk = 0.8, of_jerk_by_both = 0.1;

template <class Use>
void for_bounds(const PathCurve& u, const PathCurve& w, double length, const PathLimits& limits,
                const Use& use) {
    const auto bound = [&](double tangent, double turn, const PathLimit& limit) {
        if (tangent == 0) return;
        use(CornerBound{tangent, 1.5 * turn / length, 6 * turn / (length * length), limit});
    };
    bound(1, bend_between(u, w), limits.path);
    for (std::size_t i = 0; i < most_path_axes; ++i)
        bound(std::max(std::abs(u.u[i]), std::abs(w.u[i])), std::abs(w.u[i] - u.u[i]),
              limits.axes[i]);
}

/// The box of README.md, "Corners".
PathLimit corner_cap(const PathCurve& before, const PathCurve& after, double length,
                     const PathLimits& limits, const PathLimit& most) {
    PathLimit cap = most;
    for_bounds(before, after, length, limits, [&](const CornerBound& b) {
        cap.velocity = std::min(cap.velocity, b.limit.velocity / b.tangent);
        if (b.bend == 0) return;
        cap.velocity =
            std::min({cap.velocity, std::sqrt(of_acceleration * b.limit.acceleration / b.bend),
                      Sleef_cinz_cbrtd1_u10purec(of_jerk * b.limit.jerk / b.twist)});
    });
    const double V = cap.velocity;
    for_bounds(before, after, length, limits, [&](const CornerBound& b) {
        const double left = b.limit.acceleration - b.bend * V * V;
        cap.acceleration = std::min(cap.acceleration, left / b.tangent);
        if (b.bend > 0)
            cap.acceleration =
                std::min(cap.acceleration, of_jerk_by_both * b.limit.jerk / (3 * b.bend * V));
    });
    const double A = cap.acceleration;
    for_bounds(before, after, length, limits, [&](const CornerBound& b) {
        const double left = b.limit.jerk - 3 * b.bend * V * A - b.twist * V * V * V;
        cap.jerk = std::min(cap.jerk, left / b.tangent);
    });
    return cap;
}

/// The box of README.md, "Arcs".
PathLimit cap_of(const PathCurve& curve, const PathLimits& limits) {
    const PathLimit axes = tangential(curve, limits);
    PathLimit cap{std::min(limits.path.velocity, axes.velocity),
                  std::min(limits.path.acceleration, axes.acceleration),
                  std::min(limits.path.jerk, axes.jerk)};
    if (curve.kind == PathCurveKind::line) return cap;
    const double R = curve.radius;
    const double steady = Sleef_cinz_cbrtd1_u10purec(0.5 * axes.jerk * R * R);
    cap.velocity = std::min({cap.velocity, std::sqrt(0.9 * axes.acceleration * R), steady});
    const double V = cap.velocity;
    cap.acceleration =
        std::min({cap.acceleration, 0.4 * axes.acceleration, 0.2 * axes.jerk * R / V});
    cap.jerk = std::min(cap.jerk, 0.8 * axes.jerk - V * V * V / (R * R));
    return cap;
}

/// Tangent and curvature agree: then the joint is passed in motion.
bool is_smooth(const PathCurve& before, const PathCurve& after) {
    constexpr double rounding = 1e-12;
    const PathPoint a = before.at(before.length), b = after.at(0);
    double bend = 0;
    for (const double x : a.bend) bend = std::max(bend, std::abs(x));
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        if (std::abs(a.tangent[i] - b.tangent[i]) > rounding) return false;
        if (std::abs(a.bend[i] - b.bend[i]) > rounding * bend) return false;
    }
    return true;
}

/// The greatest velocity from which a piece can be left with `exit`, its acceleration 0 at both
/// ends. A little less: what rounds there must not decide whether a ramp has room.
double entry_velocity(const PathPiece& piece, double exit) {
    SevenSegmentPlan back;
    const double V = piece.cap.velocity;
    const SevenSegment problem{
        exit, V, V, piece.cap.acceleration, piece.cap.jerk, piece.curve.length};
    if (plan(problem, back) != PlanResult::ok) return 0;
    return back.end.velocity * (1 - 1e-9);
}

/// The way of the direct ramp from a state to a velocity.
double way_to(const MotionState& from, double velocity, const PathLimit& cap) {
    VelocityRamp ramp;
    if (ramp.plan(from.velocity, from.acceleration, velocity, cap.acceleration, cap.jerk) !=
        PlanResult::ok) {
        return std::numeric_limits<double>::infinity();
    }
    return ramp.end.position;
}

/// The velocity nearest to `wanted` that the direct ramp reaches within `room`, found from `known`,
/// which it does reach; below 0 where that is not so.
double exit_velocity(const MotionState& from, double room, double wanted, double known,
                     const PathLimit& cap) {
    if (way_to(from, wanted, cap) <= room) return wanted;
    if (!(way_to(from, known, cap) <= room)) return -1;
    double reached = known, missed = wanted;
    for (int step = 0; step < 52; ++step) {
        const double middle = 0.5 * (reached + missed);
        (way_to(from, middle, cap) <= room ? reached : missed) = middle;
    }
    return reached;
}

bool plan_within(const PathLimit& cap, double velocity, const MotionState& from, const Goal& goal,
                 MotionPlan& out) {
    MotionLimits limits;
    return limits.set(velocity, -velocity, cap.acceleration, cap.acceleration, cap.jerk) ==
               PlanResult::ok &&
           plan(limits, from, goal, out, {Entry::gentle, 1024}) == PlanResult::ok;
}

/// Where the velocity is to fall on a way that is too short for it, the plan would come back.
bool turns_round(const MotionPlan& plan) {
    for (std::size_t i = 0; i < plan.count; ++i) {
        const MotionPlan::Phase& phase = plan.phases[i];
        const MotionState& s = phase.start;
        const double lowest =
            s.jerk > 0 ? std::clamp(-s.acceleration / s.jerk, 0.0, phase.duration) : phase.duration;
        if (s.after(lowest).velocity < -1e-9 * (1 + std::abs(s.velocity))) return true;
    }
    return false;
}

/// Whether what is commanded could be planned from `from`, with `known` as above.
bool plan_piece(const PathPiece& piece, const MotionState& from, double factor, double known,
                MotionPlan& out) {
    const double room = piece.curve.length - from.position;
    if (factor == 0) {
        const double way = way_to(from, 0, piece.cap);
        if (way <= room) {
            const double V = piece.cap.velocity;
            return plan_within(piece.cap, V, from,
                               {std::min(from.position + way, piece.curve.length), 0}, out);
        }
    }
    const double wanted = std::min(piece.exit, factor * piece.joint);
    const double exit = exit_velocity(from, room, wanted, known, piece.cap);
    if (exit < 0) return false;
    const Goal goal{piece.curve.length, exit};
    const double V = std::max(factor * piece.cap.velocity, exit);
    return (V > 0 && plan_within(piece.cap, V, from, goal, out) && !turns_round(out)) ||
           plan_within(piece.cap, piece.cap.velocity, from, goal, out);
}

double factor_of(const Path& path) {
    return path.halted ? 0 : std::min(path.override, 1.0);
}

/// The velocity at the end of the piece under way that was planned, where it is still allowed.
double still_reached(const Path& path, const PathPiece& piece) {
    return std::min(path.plan.end.velocity, piece.exit);
}

/// Plans the piece under way anew from now; where that cannot be, what was planned goes on.
void plan_anew(Path& path, std::span<const PathPiece> ring) {
    const MotionState from = path.plan.at(path.time);
    MotionPlan anew;
    const PathPiece& piece = piece_at(ring, path.first);
    if (!plan_piece(piece, from, factor_of(path), still_reached(path, piece), anew)) return;
    path.plan = anew;
    path.time = 0;
    path.phase = 0;
}

/// The piece under way is over: on to the next one, at the velocity that was left with.
void enter_next(Path& path, std::span<const PathPiece> ring) {
    const double velocity = path.plan.end.velocity;
    path.travelled += piece_at(ring, path.first).curve.length;
    path.time -= path.plan.duration;
    path.phase = 0;
    ++path.first;
    path.plan = {};
    if (path.finished()) {
        path.travelled = path.total;
        path.time = 0;
        return;
    }
    const PathPiece& piece = piece_at(ring, path.first);
    const MotionState from{0, velocity, 0, 0};
    path.lost =
        !plan_piece(piece, from, factor_of(path), std::min(velocity, piece.exit), path.plan);
}

bool at_end_of_piece(const Path& path, std::span<const PathPiece> ring) {
    return path.time >= path.plan.duration &&
           path.plan.end.position == piece_at(ring, path.first).curve.length;
}

/// Joined but for rounding.
bool is_joined(const PathCurve& before, const PathCurve& after) {
    const PathVector start = after.at(0).position;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const double size = std::abs(before.end[i]) + after.length + after.radius;
        if (std::abs(start[i] - before.end[i]) > 1e-12 * size) return false;
    }
    return true;
}

/// After an append the pieces before may be left faster: back to the first that is as it was.
void look_back(Path& path, std::span<PathPiece> ring) {
    for (std::uint64_t k = path.count - 1; k > path.first; --k) {
        PathPiece& piece = piece_at(ring, k - 1);
        const PathPiece& next = piece_at(ring, k);
        const double exit = std::min(piece.joint, entry_velocity(next, next.exit));
        if (exit <= piece.exit) return;
        piece.exit = exit;
    }
    path.stale = true;
}

/// After pieces in the ring have changed: all of them, and whether the one under way can still be
/// run along from now.
bool look_back_anew(Path& path, std::span<PathPiece> ring) {
    for (std::uint64_t k = path.count - 1; k > path.first; --k) {
        const PathPiece& next = piece_at(ring, k);
        PathPiece& piece = piece_at(ring, k - 1);
        piece.exit = std::min(piece.joint, entry_velocity(next, next.exit));
    }
    path.stale = true;
    const PathPiece& piece = piece_at(ring, path.first);
    const MotionState now = path.plan.at(path.time);
    return way_to(now, still_reached(path, piece), piece.cap) <= piece.curve.length - now.position;
}

/// The lines are as straight on as rounding lets them.
bool is_straight_on(const PathCurve& before, const PathCurve& after) {
    constexpr double rounding = 1e-9;
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (std::abs(before.u[i] - after.u[i]) > rounding) return false;
    return true;
}

/// How far from the vertex a corner between the last piece and a line can begin.
double room_of_corner(const Path& path, const PathPiece& before, const PathCurve& line) {
    constexpr double nearly = 0.99;
    double room = before.curve.length;
    if (path.first == path.count - 1) {
        const MotionState now = path.plan.at(path.time);
        room -= now.position + way_to(now, 0, before.cap);
    }
    return std::min(nearly * room, 0.5 * line.length);
}

/// Joins a line to the last one by a corner. False, and nothing has changed, where that cannot be.
bool append_round(Path& path, std::span<PathPiece> ring, PathCurve line, const PathLimit& cap,
                  const PathLimits& limits, double distance) {
    if (path.finished() || path.count - path.first + 2 > ring.size()) return false;
    PathPiece& last = piece_at(ring, path.count - 1);
    const PathPiece before = last;
    if (before.curve.kind != PathCurveKind::line || line.kind != PathCurveKind::line ||
        is_straight_on(before.curve, line))
        return false;
    const double far = std::min(distance, room_of_corner(path, before, line));
    if (!(far > 0)) return false;
    const PathCurve corner = corner_between(before.curve, line, far);
    const PathLimit round = corner_cap(before.curve, line, corner.length, limits, before.cap);
    if (!good(round)) return false;
    line.cut_start(far);
    last.curve.cut_end(far);
    if (!(last.curve.length > 0) || !(line.length > 0)) {
        last = before;
        return false;
    }
    last.joint = round.velocity;
    piece_at(ring, path.count) = {corner, round, std::min(round.velocity, cap.velocity), 0};
    piece_at(ring, path.count + 1) = {line, cap, 0, 0};
    path.count += 2;
    if (look_back_anew(path, ring)) {
        path.total += last.curve.length - before.curve.length + corner.length + line.length;
        return true;
    }
    path.count -= 2;
    last = before;
    look_back_anew(path, ring);
    return false;
}

}  // namespace

double corner_distance_at(double velocity, const PathCurve& before, const PathCurve& after,
                          const PathLimits& limits) {
    double distance = 0;
    for_bounds(before, after, 1, limits, [&](const CornerBound& b) {
        const double square = velocity * velocity;
        const double by_acceleration =
            0.5 * b.bend * square / (of_acceleration * b.limit.acceleration);
        const double by_jerk =
            0.5 * std::sqrt(b.twist * square * velocity / (of_jerk * b.limit.jerk));
        distance = std::max({distance, by_acceleration, by_jerk});
    });
    return distance;
}

PathFault Path::append(std::span<PathPiece> ring, const PathCurve& curve, const PathLimits& limits,
                       const PathJoint& joint) {
    if (count - first >= ring.size()) return PathFault::full;
    if (!good(limits.path)) return PathFault::limit_not_positive;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        if (curve.share(i) > 0 && !good(limits.axes[i])) return PathFault::limit_not_positive;
    }
    const PathLimit cap = cap_of(curve, limits);
    if (!good(cap)) return PathFault::not_finite;
    if (count > first) {
        PathPiece& before = piece_at(ring, count - 1);
        if (!is_joined(before.curve, curve)) return PathFault::not_joined;
        if (joint.distance > 0 && append_round(*this, ring, curve, cap, limits, joint.distance))
            return PathFault::none;
        const bool smooth = is_smooth(before.curve, curve);
        before.joint = smooth ? std::min({before.cap.velocity, cap.velocity, joint.velocity}) : 0;
    }
    piece_at(ring, count) = {curve, cap, 0, 0};
    ++count;
    total += curve.length;
    look_back(*this, ring);
    return PathFault::none;
}

void Path::set_override(double factor) {
    override = factor;
    stale = true;
}

void Path::halt() {
    halted = true;
    stale = true;
}

void Path::resume() {
    halted = false;
    stale = true;
}

void Path::clear() {
    const double factor = override;
    *this = {};
    override = factor;
}

PathMotion Path::advance(std::span<PathPiece> ring, double dt) {
    if (finished() || lost) return now(ring);
    if (stale) plan_anew(*this, ring);
    stale = false;
    time += dt;
    while (!finished() && !lost && at_end_of_piece(*this, ring)) enter_next(*this, ring);
    if (standing()) time = plan.duration;
    return now(ring);
}

PathMotion Path::now(std::span<const PathPiece> ring) const {
    PathMotion out;
    if (count == 0) return out;
    const bool over = finished();
    const PathPiece& piece = piece_at(ring, over ? first - 1 : first);
    const MotionState m = plan.at(time);
    const PathPoint x = piece.curve.at(over ? piece.curve.length : m.position);
    out.path = m;
    out.path.position += travelled;
    const double v = m.velocity, a = m.acceleration, j = m.jerk;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        out.position[i] = x.position[i];
        out.velocity[i] = x.tangent[i] * v;
        out.acceleration[i] = x.tangent[i] * a + x.bend[i] * v * v;
        out.jerk[i] = x.tangent[i] * j + 3 * x.bend[i] * v * a + x.twist[i] * v * v * v;
    }
    return out;
}

double Path::remaining() const {
    return total - travelled - plan.at(time).position;
}

}  // namespace lineshaft

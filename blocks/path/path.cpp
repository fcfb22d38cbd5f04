#include "blocks/path/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "blocks/path/path_ahead.hpp"
#include "blocks/path/path_spline.hpp"

namespace lineshaft {

namespace {

PathPiece& piece_at(std::span<PathPiece> ring, std::uint64_t number) {
    return ring[number % ring.size()];
}

const PathPiece& piece_at(std::span<const PathPiece> ring, std::uint64_t number) {
    return ring[number % ring.size()];
}

/// Tangent and curvature agree: then the joint is passed in motion.
bool is_smooth(const PathCurve& before, const PathCurve& after) {
    constexpr double rounding = 1e-9;
    const PathPoint a = before.at(before.length), b = after.at(0);
    double bend = 1 / (before.length + after.length);
    for (const double x : a.bend) bend = std::max(bend, std::abs(x));
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        if (std::abs(a.tangent[i] - b.tangent[i]) > rounding) return false;
        if (std::abs(a.bend[i] - b.bend[i]) > rounding * bend) return false;
    }
    return true;
}

ConstPathStretches stretches_of(const Path& path, std::span<const PathPiece> ring) {
    return {ring, path.stretch, path.stretches};
}

/// `relied`: what the leg under way needs holds still.
void look_back_where_changed(Path& path, std::span<PathPiece> ring, bool relied = true) {
    if (path.changed == path.stretches) return;
    PathReliance on;
    if (relied) on = {path.leg.goal + 1, path.leg.end_velocity()};
    look_back({ring, path.stretch, path.stretches}, path.changed, on);
    path.changed = path.stretches;
}

void note_change(Path& path, std::uint64_t stretch) {
    path.changed = std::min(path.changed, stretch);
    path.fresh = true;
}

MotionState state_of(const Path& path) {
    return path.leg.at(path.time);
}

/// Along the path, from its start on [u].
double place_of(const Path& path, const MotionState& now) {
    return path.time >= path.leg.duration() ? path.leg.end : path.leg.base + now.position;
}

double place_of(const Path& path) {
    return place_of(path, state_of(path));
}

double factor_of(const Path& path) {
    return path.halted ? 0 : std::min(path.override, 1.0);
}

/// The leg ends within a stretch that has grown, and nothing is halted there.
bool stops_short(const Path& path, std::span<const PathPiece> ring) {
    return path.leg.end != piece_at(ring, path.leg.goal).stretch.end && factor_of(path) > 0;
}

PathOutlook outlook_of(const Path& path, std::span<const PathPiece> ring) {
    return {
        stretches_of(path, ring), {ring, path.first, path.count}, factor_of(path), path.braking};
}

/// A command is tried again in the next scan, and anything else at instants of the leg.
void try_later(Path& path, bool commanded) {
    constexpr double part_of_leg = 1.0 / 16;
    const double lasts = path.leg.duration();
    const double then = std::min(path.time + part_of_leg * lasts, lasts);
    path.stale = commanded || !(then > path.time);
    path.again = path.stale ? Path::any_time : then;
}

/// A course that ends where not all of the path is over is looked at again as soon as it comes down
/// to that end.
void note_leg(Path& path, std::span<const PathPiece> ring) {
    constexpr double at_least = 0.05;
    path.stale = false;
    path.again = Path::any_time;
    if (stops_short(path, ring)) try_later(path, false);
    path.fresh = path.leg.course.count > 0 && path.leg.goal + 1 < path.stretches &&
                 path.leg.ripe > at_least * path.leg.duration();
}

/// The halt that was found, or a harder one that is over sooner; none where what is planned is.
IntoBoxes halt_harder(const Path& path, const PathOutlook& outlook, const MotionState& from,
                      IntoBoxes found, PathLeg& leg) {
    constexpr double worth = 0.999, infinite = std::numeric_limits<double>::infinity();
    const double otherwise = found == IntoBoxes::none ? infinite : leg.duration();
    const double left = path.leg.end_velocity() == 0 ? path.leg.duration() - path.time : infinite;
    const IntoBoxes harder =
        plan_harder_halt(outlook, from, place_of(path), worth * std::min(otherwise, left), leg);
    if (harder != IntoBoxes::none) return harder;
    return left < otherwise ? IntoBoxes::none : found;
}

/// Plans anew from now; where that cannot be, what was planned goes on.
bool plan_anew(Path& path, std::span<PathPiece> ring) {
    const bool commanded = path.stale;
    look_back_where_changed(path, ring);
    path.fresh = false;
    if (commanded) path.vain = {};
    MotionState from = state_of(path);
    from.position = 0;
    const double base = place_of(path);
    const PathOutlook outlook = outlook_of(path, ring);
    PathLeg leg;
    IntoBoxes into = IntoBoxes::soon;
    if (!plan_leg(outlook.stretches, from, base, outlook.factor, path.braking, leg))
        into =
            path.leg.course.count > 0 ? plan_into_boxes(outlook, from, base, leg) : IntoBoxes::none;
    if (path.halted) into = halt_harder(path, outlook, from, into, leg);
    if (into == IntoBoxes::none) return false;
    if (outlook.factor > 0 && into == IntoBoxes::soon) look_ahead(outlook, 0, leg, path.vain);
    path.leg = leg;
    path.time = 0;
    note_leg(path, ring);
    if (into == IntoBoxes::late) try_later(path, commanded);
    return true;
}

/// What is known of the path by now may make the course under way sooner.
void go_on(Path& path, std::span<PathPiece> ring) {
    look_back_where_changed(path, ring);
    path.fresh = false;
    const PathOutlook outlook = outlook_of(path, ring);
    if (outlook.factor > 0 && path.time < path.leg.duration() &&
        look_ahead(outlook, path.time, path.leg, path.vain)) {
        path.time = 0;
        note_leg(path, ring);
    } else if (stops_short(path, ring)) {
        try_later(path, false);
    }
}

/// Pieces have come that count now, or what could not be planned may be by now.
bool is_due(const Path& path) {
    return path.stale || path.time >= path.again || (path.fresh && path.time >= path.leg.ripe);
}

/// Where a command is not planned, and nothing is, it stands.
void look(Path& path, std::span<PathPiece> ring) {
    const bool commanded = path.stale;
    path.again = Path::any_time;
    if (!commanded && path.fresh && path.leg.course.count > 0 && path.time >= path.leg.ripe)
        return go_on(path, ring);
    if (plan_anew(path, ring)) return;
    try_later(path, commanded);
    path.lost = path.standing() && factor_of(path) > 0;
}

bool at_end_of_stretch(const Path& path, std::span<PathPiece> ring) {
    return path.time >= path.leg.duration() &&
           path.leg.end == piece_at(ring, path.leg.goal).stretch.end;
}

/// The leg is over: on with the next one, at the velocity that was left with.
void enter_next(Path& path, std::span<PathPiece> ring) {
    const MotionState from{0, path.leg.end_velocity(), 0, 0};
    path.time = 0;
    path.stretch = path.leg.goal + 1;
    look_back_where_changed(path, ring);
    const double base = path.leg.end;
    path.leg.stand(base, path.stretch);
    if (path.stretch == path.stretches) {
        path.first = path.count;
        return;
    }
    const PathOutlook outlook = outlook_of(path, ring);
    path.lost = !plan_leg(outlook.stretches, from, base, outlook.factor, path.braking, path.leg);
    if (!path.lost && outlook.factor > 0) look_ahead(outlook, 0, path.leg, path.vain);
    note_leg(path, ring);
}

/// The piece and the stretch under way.
void move_up(Path& path, std::span<const PathPiece> ring, double place) {
    while (path.stretch < path.leg.goal && place >= piece_at(ring, path.stretch).stretch.end)
        ++path.stretch;
    const auto is_left = [&](const PathPiece& piece) {
        return place >= piece.end() && piece.end() < path.leg.end;
    };
    while (path.first + 1 < path.count && is_left(piece_at(ring, path.first))) ++path.first;
}

/// The instant of the leg under way at which a piece on its way is entered.
double time_of_entry(const Path& path, std::span<const PathPiece> ring, std::uint64_t piece) {
    if (piece >= path.count) return Path::any_time;
    const double begin = piece_at(ring, piece).begin;
    return begin < path.leg.end ? path.leg.time_at(begin - path.leg.base) : Path::any_time;
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

/// How far from the vertex a corner between the last piece and a line can begin.
double room_of_corner(const Path& path, std::span<const PathPiece> ring, const PathCurve& line) {
    constexpr double nearly = 0.99;
    const PathPiece& before = piece_at(ring, path.count - 1);
    double room = before.curve.length;
    if (path.first == path.count - 1) {
        const PathLimit& box = piece_at(ring, path.stretches - 1).stretch.box;
        room = before.end() - place_of(path) - way_to(state_of(path), 0, box);
    }
    return std::min(nearly * room, 0.5 * line.length);
}

/// A stretch of its own for the last piece, or more of the last stretch.
void append_stretch(Path& path, std::span<PathPiece> ring, const PathLimit& box, double joint) {
    const auto as_great = [](double a, double b) { return std::abs(a - b) <= 1e-10 * b; };
    const PathPiece& piece = piece_at(ring, path.count - 1);
    path.total = piece.end();
    if (path.stretches > path.stretch) {
        PathStretch& last = piece_at(ring, path.stretches - 1).stretch;
        note_change(path, path.stretches - 1);
        if (joint >= box.velocity && as_great(box.velocity, last.box.velocity) &&
            as_great(box.acceleration, last.box.acceleration) &&
            as_great(box.jerk, last.box.jerk)) {
            last.end = piece.end();
            return;
        }
        last.joint = std::min({last.box.velocity, box.velocity, joint});
    }
    note_change(path, path.stretches);
    PathStretch& added = piece_at(ring, path.stretches).stretch;
    added = {};
    added.box = added.span = box;
    added.begin = piece.begin;
    added.end = added.settled = added.ramp_end = piece.end();
    added.target = path.stretches;
    ++path.stretches;
}

/// The way of the first three axes, to the end of a piece [u].
double way_behind(const PathPiece& piece) {
    return piece.way + piece.curve.way_at(piece.curve.length).way;
}

void append_piece(Path& path, std::span<PathPiece> ring, const PathCurve& curve,
                  const PathLimits& limits, const PathLimit& box, double joint) {
    PathPiece& piece = piece_at(ring, path.count);
    piece.curve = curve;
    piece.limits = limits;
    piece.bounds = bounds_of(curve);
    piece.begin = path.total;
    piece.way = path.count > 0 ? way_behind(piece_at(ring, path.count - 1)) : 0;
    ++path.count;
    append_stretch(path, ring, box, joint);
}

/// After the last piece has been cut: whether what is planned holds still, or can be mended.
bool holds(Path& path, std::span<PathPiece> ring, std::uint64_t cut) {
    if (path.standing()) return true;
    look_back_where_changed(path, ring, false);
    if (path.leg.goal < cut &&
        path.leg.end_velocity() <= stretches_of(path, ring).exit(path.leg.goal))
        return true;
    return plan_anew(path, ring);
}

/// The curves that round the joint of two, `far` from it, and the box of each.
struct Round {
    std::size_t count = 0;
    std::array<PathCurve, most_spline_parts> curves;
    std::array<PathLimit, most_spline_parts> boxes;
};

bool find_round(const PathCurve& before, const PathCurve& after, double far,
                const PathLimits& limits, Round& out) {
    const bool lines = before.kind == PathCurveKind::line && after.kind == PathCurveKind::line;
    if (lines) {
        out.count = 1;
        out.curves[0] = corner_between(before, after, far);
        out.boxes[0] = box_of_corner(before, after, out.curves[0].length, limits);
    } else {
        out.count = spline_between(before.at(before.length - far), after.at(far), out.curves);
        for (std::size_t i = 0; i < out.count; ++i) out.boxes[i] = box_of(out.curves[i], limits);
    }
    for (std::size_t i = 0; i < out.count; ++i)
        if (!is_good(out.boxes[i])) return false;
    return out.count > 0 && out.count <= most_transition_parts;
}

/// Joins a line or an arc to the last one by a corner or a transition. False, and nothing has
/// changed, where that cannot be.
bool append_round(Path& path, std::span<PathPiece> ring, PathCurve next, const PathLimit& box,
                  const PathLimits& limits, const PathJoint& joint) {
    if (path.finished() || path.count - path.first + 2 > ring.size()) return false;
    PathPiece& last = piece_at(ring, path.count - 1);
    PathStretch& cut = piece_at(ring, path.stretches - 1).stretch;
    const PathCurve curve = last.curve;
    if (!curve.is_line_or_arc() || !next.is_line_or_arc() || is_smooth(curve, next)) return false;
    const double most = std::min(joint.distance, room_of_corner(path, ring, next));
    const double far = distance_within(joint.deviation, curve, next, most);
    const PathLimits both = limits_between(last.limits, limits, joint.blend);
    constexpr double least = 1e-9;
    Round round;
    if (!(far > least * (curve.length + next.length)) ||
        !find_round(curve, next, far, both, round) ||
        path.count - path.first + 1 + round.count > ring.size())
        return false;
    next.cut_start(far);
    last.curve.cut_end(far);
    if (!(last.curve.length > 0) || !(next.length > 0)) {
        last.curve = curve;
        return false;
    }
    constexpr double any = std::numeric_limits<double>::infinity();
    const std::uint64_t count = path.count, stretches = path.stretches, changed = path.changed;
    const double total = path.total;
    path.total = cut.end = last.end();
    for (std::size_t i = 0; i < round.count; ++i)
        append_piece(path, ring, round.curves[i], both, round.boxes[i], any);
    append_piece(path, ring, next, limits, box, any);
    if (holds(path, ring, stretches - 1)) return true;
    path.count = count, path.stretches = stretches, path.changed = changed;
    path.total = cut.end = total;
    last.curve = curve;
    cut.joint = 0;
    note_change(path, path.stretches - 1);
    look_back_where_changed(path, ring, false);
    return false;
}

/// The motion at a state whose position counts from the start of the path.
PathMotion motion_of(const Path& path, std::span<const PathPiece> ring, const MotionState& m) {
    PathMotion out;
    if (path.count == 0) return out;
    const bool over = path.finished();
    const PathPiece& piece = piece_at(ring, over ? path.first - 1 : path.first);
    const double s = over ? piece.curve.length : m.position - piece.begin;
    const PathPoint x = piece.curve.at(s);
    const PathCurve::Way way = piece.curve.way_at(s);
    const double v = m.velocity, a = m.acceleration, j = m.jerk;
    out.path = m;
    out.way = {piece.way + way.way, way.slope * v, way.slope * a + way.bend * v * v,
               way.slope * j + 3 * way.bend * v * a + way.twist * v * v * v};
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        out.position[i] = x.position[i];
        out.velocity[i] = x.tangent[i] * v;
        out.acceleration[i] = x.tangent[i] * a + x.bend[i] * v * v;
        out.jerk[i] = x.tangent[i] * j + 3 * x.bend[i] * v * a + x.twist[i] * v * v * v;
    }
    return out;
}

}  // namespace

PathFault Path::append(std::span<PathPiece> ring, const PathCurve& curve, const PathLimits& limits,
                       const PathJoint& joint) {
    if (count - first >= ring.size()) return PathFault::full;
    if (!is_good(limits.path)) return PathFault::limit_not_positive;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        if (curve.moves(i) && !is_good(limits.axes[i])) return PathFault::limit_not_positive;
    }
    const PathLimit box = box_of(curve, limits);
    if (!is_good(box)) return PathFault::not_finite;
    double velocity = 0;
    if (count > first) {
        const PathCurve& before = piece_at(ring, count - 1).curve;
        if (!is_joined(before, curve)) return PathFault::not_joined;
        if (joint.distance > 0 && append_round(*this, ring, curve, box, limits, joint))
            return PathFault::none;
        if (is_smooth(before, curve)) velocity = joint.velocity;
    }
    append_piece(*this, ring, curve, limits, box, velocity);
    return PathFault::none;
}

void Path::set_override(double factor) {
    override = factor;
    stale = true;
}

void Path::halt(const PathLimit& limit) {
    braking = limit;
    halted = true;
    stale = true;
}

void Path::resume() {
    braking = no_path_limit;
    halted = false;
    stale = true;
}

void Path::clear() {
    const double factor = override;
    *this = {};
    override = factor;
}

PathMotion Path::advance(std::span<PathPiece> ring, double dt) {
    advance_to(ring, dt, to_end);
    return now(ring);
}

double Path::advance_to(std::span<PathPiece> ring, double dt, std::uint64_t piece) {
    double elapsed = 0;
    if (stale && !finished() && !lost) look(*this, ring);
    while (!finished() && !lost && first < piece) {
        if (!stale && is_due(*this)) {
            look(*this, ring);
            continue;
        }
        const double end = leg.duration(), left_at = time_of_entry(*this, ring, piece);
        const double next = std::min({end, left_at, again, fresh ? leg.ripe : any_time});
        const double left = dt - elapsed;
        if (time + left < next || (time >= end && !at_end_of_stretch(*this, ring))) {
            time += left;
            elapsed = dt;
            break;
        }
        elapsed = std::min(dt, elapsed + std::max(next - time, 0.0));
        time = std::max(time, next);
        if (at_end_of_stretch(*this, ring)) enter_next(*this, ring);
        if (time >= left_at) first = piece;
        if (!finished()) move_up(*this, ring, place_of(*this));
    }
    if (standing()) time = leg.duration();
    if (!finished()) move_up(*this, ring, place_of(*this));
    return elapsed;
}

PathMotion Path::now(std::span<const PathPiece> ring) const {
    MotionState m = state_of(*this);
    m.position = place_of(*this, m);
    return motion_of(*this, ring, m);
}

double Path::remaining() const {
    return total - place_of(*this);
}

}  // namespace lineshaft

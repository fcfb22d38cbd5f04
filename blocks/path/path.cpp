#include "blocks/path/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "blocks/path/path_ahead.hpp"
#include "blocks/path/path_known.hpp"
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

/// With as much of the path as counts for it.
bool plan_leg_from(Path& path, std::span<PathPiece> ring, const MotionState& from, double base,
                   const PathReliance& relied, PathLeg& leg) {
    look_back_as_needed(path, ring, relied);
    const auto is_planned = [&] {
        return plan_leg(stretches_of(path, ring), from, base, factor_of(path), path.braking, leg);
    };
    bool is_found = is_planned();
    if (is_found && is_sure(path, leg)) {
        leg.ripe = Path::any_time;
    } else if (path.known < path.stretches) {
        look_back_from(path, ring, path.stretches, relied);
        is_found = is_planned();
    }
    return is_found;
}

/// Plans anew from now; where that cannot be, what was planned goes on.
bool plan_anew(Path& path, std::span<PathPiece> ring) {
    const bool commanded = path.stale;
    path.fresh = false;
    if (commanded) path.vain = {};
    MotionState from = state_of(path);
    from.position = 0;
    const double base = place_of(path);
    PathLeg leg;
    IntoBoxes into = IntoBoxes::soon;
    const bool is_found = plan_leg_from(path, ring, from, base, reliance_of(path), leg);
    const PathOutlook outlook = outlook_of(path, ring);
    if (!is_found)
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
    look_back_as_needed(path, ring, reliance_of(path));
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
    const double base = path.leg.end;
    path.leg.stand(base, path.stretch);
    if (path.stretch == path.stretches) {
        path.first = path.count;
        return;
    }
    const PathReliance relied{path.stretch, from.velocity};
    path.lost = !plan_leg_from(path, ring, from, base, relied, path.leg);
    if (path.lost) path.leg.stand(base, path.stretch);
    const PathOutlook outlook = outlook_of(path, ring);
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
    if (path.standing() || cut >= path.known) return true;
    const auto can_go_on = [&] {
        return path.leg.end_velocity() <= stretches_of(path, ring).exit(path.leg.goal);
    };
    if (is_sure(path, path.leg) && cut > path.stretch + most_pieces_ahead) {
        look_back_from(path, ring, cut, {});
        if (is_sure(path, path.leg) && can_go_on()) return true;
    }
    look_back_from(path, ring, path.stretches, {});
    if (path.leg.goal < cut && can_go_on()) return true;
    return plan_anew(path, ring);
}

/// The curves that round the joint of two, and the box of each.
struct Round {
    double far = 0;     ///< from the joint they begin and end [u]
    PathLimits limits;  ///< of each of them
    std::span<const PathCurve> curves;
    std::span<const PathLimit> boxes;
};

/// What is appended: a curve with its box.
struct Next {
    PathCurve curve;
    const PathLimit& box;
    const PathLimits& limits;
};

/// Between the last piece and the next one. False, and nothing has changed, where that cannot be.
bool append_round(Path& path, std::span<PathPiece> ring, Next next, const Round& round) {
    if (path.count - path.first + 1 + round.curves.size() > ring.size() ||
        !std::all_of(round.boxes.begin(), round.boxes.end(), is_good))
        return false;
    PathPiece& last = piece_at(ring, path.count - 1);
    PathStretch& cut = piece_at(ring, path.stretches - 1).stretch;
    const PathCurve curve = last.curve;
    next.curve.cut_start(round.far);
    last.curve.cut_end(round.far);
    if (!(last.curve.length > 0) || !(next.curve.length > 0)) {
        last.curve = curve;
        return false;
    }
    constexpr double any = std::numeric_limits<double>::infinity();
    const std::uint64_t count = path.count, stretches = path.stretches, changed = path.changed;
    const double total = path.total;
    path.total = cut.end = last.end();
    for (std::size_t i = 0; i < round.curves.size(); ++i)
        append_piece(path, ring, round.curves[i], round.limits, round.boxes[i], any);
    append_piece(path, ring, next.curve, next.limits, next.box, any);
    if (holds(path, ring, stretches - 1)) return true;
    path.count = count, path.stretches = stretches, path.changed = changed;
    path.total = cut.end = total;
    last.curve = curve;
    cut.joint = 0;
    note_change(path, path.stretches - 1);
    look_back_from(path, ring, path.stretches, {});
    return false;
}

bool append_corner(Path& path, std::span<PathPiece> ring, const Next& next, Round& round) {
    const PathCurve& before = piece_at(ring, path.count - 1).curve;
    const PathCurve corner = corner_between(before, next.curve, round.far);
    const PathLimit box = box_of_corner(before, next.curve, corner.length, round.limits);
    round.curves = {&corner, 1};
    round.boxes = {&box, 1};
    return append_round(path, ring, next, round);
}

bool append_transition(Path& path, std::span<PathPiece> ring, const Next& next, Round& round) {
    const PathCurve& before = piece_at(ring, path.count - 1).curve;
    std::array<PathCurve, most_spline_parts> curves;
    std::array<PathLimit, most_transition_parts> boxes;
    const std::size_t count =
        spline_between(before.at(before.length - round.far), next.curve.at(round.far), curves);
    if (count == 0 || count > boxes.size()) return false;
    const PathLimits both = round.limits;
    for (std::size_t i = 0; i < count; ++i)
        round.limits.path = least_of(round.limits.path, limits_on(curves[i], both).path);
    for (std::size_t i = 0; i < count; ++i) boxes[i] = box_of(curves[i], round.limits);
    round.curves = {curves.data(), count};
    round.boxes = {boxes.data(), count};
    return append_round(path, ring, next, round);
}

/// Joins a line or an arc to the last one by a corner or a transition. False, and nothing has
/// changed, where that cannot be.
bool append_round(Path& path, std::span<PathPiece> ring, const Next& next, const PathJoint& joint) {
    if (path.finished() || path.count - path.first + 2 > ring.size()) return false;
    const PathPiece& last = piece_at(ring, path.count - 1);
    const PathCurve& before = last.curve;
    if (!before.is_line_or_arc() || !next.curve.is_line_or_arc() || is_smooth(before, next.curve))
        return false;
    const double most = std::min(joint.distance, room_of_corner(path, ring, next.curve));
    Round round;
    round.far = distance_within(joint.deviation, before, next.curve, most);
    constexpr double least = 1e-9;
    if (!(round.far > least * (before.length + next.curve.length))) return false;
    round.limits = limits_between(last.limits, next.limits, joint.blend);
    const bool lines = before.kind == PathCurveKind::line && next.curve.kind == PathCurveKind::line;
    return lines ? append_corner(path, ring, next, round)
                 : append_transition(path, ring, next, round);
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
    const PathLimits along = limits_on(curve, limits);
    const PathLimit box = box_of(curve, along);
    if (!is_good(box)) return PathFault::not_finite;
    double velocity = 0;
    if (count > first) {
        const PathCurve& before = piece_at(ring, count - 1).curve;
        if (!is_joined(before, curve)) return PathFault::not_joined;
        if (joint.distance > 0 && append_round(*this, ring, {curve, box, along}, joint))
            return PathFault::none;
        if (is_smooth(before, curve)) velocity = joint.velocity;
    }
    append_piece(*this, ring, curve, along, box, velocity);
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

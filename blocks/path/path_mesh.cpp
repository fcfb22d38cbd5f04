#include "blocks/path/path_mesh.hpp"

#include <algorithm>
#include <cmath>

#include <sleef.h>

namespace lineshaft {

namespace {

/// Into how many equal times a whole course is divided, and how many intervals are put into the
/// time in which the distance from standstill grows e-fold.
constexpr double equal_times = 20, grading = 3;

/// How many intervals there are to be until a time.
double intervals_until(double t, const PathCourse& guess, const MeshWish& wish) {
    const auto folds = [](double time, double rest) {
        return rest > 0 ? Sleef_cinz_logd1_u10purec(std::max(time / rest, 1.0)) : 0;
    };
    return equal_times * t / guess.duration +
           grading * (folds(t, wish.from_rest) - folds(guess.duration - t, wish.to_rest));
}

/// Two directions in the plane of a corner, upright on each other.
std::array<PathVector, 2> plane_of(const PathCurve& corner) {
    std::array<PathVector, 2> out{};
    std::array<double, 2> squares{};
    for (std::size_t i = 0; i < path_space; ++i) {
        out[0][i] = corner.w[i] + corner.u[i];
        out[1][i] = corner.w[i] - corner.u[i];
        for (std::size_t k = 0; k < 2; ++k) squares[k] += out[k][i] * out[k][i];
    }
    for (std::size_t k = 0; k < 2; ++k)
        for (double& x : out[k]) x /= squares[k] > 0 ? std::sqrt(squares[k]) : 1;
    return out;
}

/// The greatest velocity at which a point is passed without acceleration.
double steady_velocity(const PathPoint& x, const PathLimits& limits) {
    double v = limits.path.velocity;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const double bend = std::abs(x.bend[i]), twist = std::abs(x.twist[i]);
        if (bend > 0) v = std::min(v, std::sqrt(limits.axes[i].acceleration / bend));
        if (twist > 0) v = std::min(v, Sleef_cinz_cbrtd1_u10purec(limits.axes[i].jerk / twist));
    }
    return v;
}

/// Between its ends a tangent is at most length^2/8 of the twist greater; a fifth is on the safe
/// side of a twist that is known at the ends alone.
double greatest_velocity(const SpeedInterval& i, double factor) {
    constexpr double bulge = 0.2;
    double v = i.along.velocity;
    for (std::size_t k = 0; k < most_path_axes; ++k) {
        const double tangent = std::max(std::abs(i.left.tangent[k]), std::abs(i.right.tangent[k]));
        const double twist = std::max(std::abs(i.left.twist[k]), std::abs(i.right.twist[k]));
        const double most = tangent + bulge * twist * i.length * i.length;
        if (most > 0) v = std::min(v, i.limits->axes[k].velocity / most);
    }
    if (factor < 1)
        v = factor *
            std::min({v, steady_velocity(i.left, *i.limits), steady_velocity(i.right, *i.limits)});
    return v;
}

SpeedInterval interval_on(const PathPiece& piece, double base, double begin, double end,
                          double factor) {
    constexpr double margin = 0.998;
    SpeedInterval out;
    out.begin = begin;
    out.length = end - begin;
    out.limits = &piece.limits;
    out.kind = piece.curve.kind;
    out.left = piece.curve.at(base + begin - piece.begin);
    out.right = piece.curve.at(base + end - piece.begin);
    const bool is_line = out.kind == PathCurveKind::line;
    out.along = is_line ? box_of(piece.curve, piece.limits) : piece.limits.path;
    out.along.velocity = greatest_velocity(out, factor);
    if (out.kind == PathCurveKind::corner) out.plane = plane_of(piece.curve);
    out.tight = margin;
    return out;
}

struct Sample {
    double t = 0, value = 0;
};

/// Where a rising function comes to a value, up to `near`: by false position, in which an end that
/// stays twice counts for half.
template <class Rising>
Sample sample_at(const Rising& rising, Sample low, Sample high, double wanted, double near) {
    double below = low.value - wanted, above = high.value - wanted;
    double before = 0;
    Sample out = high;
    for (int step = 0; step < 16; ++step) {
        out.t = low.t + (high.t - low.t) * (below / (below - above));
        out.value = rising(out.t);
        const double off = out.value - wanted;
        if (std::abs(off) <= near) break;
        if (off < 0) {
            if (before < 0) above *= 0.5;
            low = out, below = off;
        } else {
            if (before > 0) below *= 0.5;
            high = out, above = off;
        }
        before = off;
    }
    return out;
}

/// The part of a piece from one place to another.
bool add_piece(const PathPieces& pieces, std::uint64_t number, const PathCourse& guess,
               const MeshWish& wish, double fineness, double from, double to, PathMesh& out) {
    const PathPiece& piece = pieces[number];
    const double first = guess.time_at(from), last = guess.time_at(to);
    const double start = intervals_until(first, guess, wish);
    const double per = fineness * mesh_need(piece).intervals / piece.curve.length;
    const auto until = [&](double t) {
        return intervals_until(t, guess, wish) - start + per * (guess.at(t).position - from);
    };
    const double all = until(last);
    const double parts = std::max(1.0, std::ceil(all));
    if (!(static_cast<double>(out.count) + parts <= static_cast<double>(out.intervals.size())))
        return false;
    const auto n = static_cast<std::size_t>(parts);
    constexpr double near = 1e-3;
    double begin = from;
    Sample at{first, 0};
    for (std::size_t k = 1; k <= n; ++k) {
        const double wanted = all * static_cast<double>(k) / parts;
        if (k < n) at = sample_at(until, at, {last, all}, wanted, near);
        const double end = k == n ? to : guess.at(at.t).position;
        if (!(end > begin)) return false;
        out.intervals[out.count] = interval_on(piece, wish.base, begin, end, wish.factor);
        const double v = guess.at(guess.time_at(0.5 * (begin + end))).velocity;
        if (!(v > 0)) return false;
        out.energies[out.count] = 0.5 * v * v;
        ++out.count;
        begin = end;
    }
    return true;
}

}  // namespace

MeshNeed mesh_need(const PathPiece& piece) {
    constexpr double angle = 0.5;  ///< of an arc [rad]
    if (piece.curve.kind == PathCurveKind::line) return {2, 5};
    double axes = 0;
    for (const PathBound& axis : piece.bounds) axes += axis.tangent > 0 ? 1 : 0;
    switch (piece.curve.kind) {
        case PathCurveKind::line:
            break;
        case PathCurveKind::arc:
            return {2 + piece.curve.length / piece.curve.radius / angle, 5 + 3 * axes};
        case PathCurveKind::corner:
            return {5, 29 + 3 * axes};
        case PathCurveKind::spline:
            return {4, 5 + 3 * axes};
    }
    return {};
}

namespace {

/// By how much more than at least the pieces are divided, if there is room for that.
double fineness_of(const PathPieces& pieces, const MeshWish& wish) {
    constexpr double most = 1.7, share = 0.6;
    MeshNeed need;
    for (std::uint64_t k = pieces.first; k < pieces.count; ++k) {
        if (pieces[k].begin - wish.base >= wish.end) break;
        const MeshNeed of = mesh_need(pieces[k]);
        need.intervals += of.intervals;
        need.rows += of.intervals * of.rows;
    }
    return std::clamp(share * std::min(most_speed_intervals / need.intervals,
                                       SpeedProblem::most_rows / need.rows),
                      1.0, most);
}

}  // namespace

bool make_mesh(const PathPieces& pieces, const PathCourse& guess, const MeshWish& wish,
               PathMesh& out) {
    constexpr std::size_t least = 4;
    const double fineness = fineness_of(pieces, wish);
    out.count = 0;
    for (std::uint64_t k = pieces.first; k < pieces.count; ++k) {
        const PathPiece& piece = pieces[k];
        const double from = std::max(piece.begin - wish.base, wish.begin);
        const double to = std::min(piece.end() - wish.base, wish.end);
        if (from >= wish.end) break;
        if (to > from && !add_piece(pieces, k, guess, wish, fineness, from, to, out)) return false;
    }
    return out.count >= least;
}

}  // namespace lineshaft

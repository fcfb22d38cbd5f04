#include "blocks/path/path_optimum.hpp"

#include <algorithm>
#include <cmath>

#include "blocks/path/path_limits_kept.hpp"
#include "blocks/path/path_mesh.hpp"

namespace lineshaft {

namespace {

/// At an end of the course its jerk lasts for a while, as w does not rise by a polynomial of the
/// way from standstill. Counted from that end.
struct EndPhase {
    double jerk = 0, lasts = 0;
    MotionState from;

    MotionState inner() const {
        MotionState s = from;
        s.jerk = jerk;
        return s.after(lasts);
    }
};

/// What a motion from standstill at a point of a piece may have.
PathLimit limit_at(const PathPiece& piece, double place) {
    const PathPoint x = piece.curve.at(place - piece.begin);
    PathLimit out = piece.limits.path;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const double share = std::abs(x.tangent[i]);
        if (share == 0) continue;
        const PathLimit& axis = piece.limits.axes[i];
        out = least_of(out, {axis.velocity / share, axis.acceleration / share, axis.jerk / share});
    }
    return out;
}

/// From standstill, or to it.
EndPhase rest_phase(const PathPiece& piece, double place, double slack, double duration) {
    constexpr double part_of_course = 0.05, part_of_ramp = 0.3;
    constexpr double on_curve = 0.97;
    const PathLimit limit = limit_at(piece, place);
    const bool is_line = piece.curve.kind == PathCurveKind::line;
    const double jerk = slack * (is_line ? 1 : on_curve) * limit.jerk;
    return {
        jerk, std::min(part_of_course * duration, part_of_ramp * limit.acceleration / jerk), {}};
}

/// From a state that is slow yet the guess is followed for a while.
EndPhase slow_phase(const PathCourse& guess) {
    constexpr double part_of_course = 0.05;
    const PathPhase& first = guess.phases[0];
    const double lasts = std::min(guess.end_of(0), part_of_course * guess.duration);
    const bool is_slow = first.slope == 0 && first.start.acceleration > 0 &&
                         first.after(lasts).velocity > 2 * first.start.velocity;
    return {first.start.jerk, is_slow ? lasts : 0, first.start};
}

class Search {
  public:
    Search(const PathPieces& path, const PathCourse& known, double start, double part)
        : pieces(path), guess(known), base(start), factor(part) {}

    bool find(PathCourse& out);

  private:
    const PathPieces& pieces;
    const PathCourse& guess;
    double base, factor;
    std::array<double, 2> slack{1, 1};  ///< of the jerk from standstill and to it
    EndPhase begin, end;
    PathMesh mesh;
    std::array<double, PathCourse::most_phases> quotients{};

    bool find_ends();
    bool write(const SpeedProblem& problem, PathCourse& out) const;
    bool is_tightened(const PathCourse& course);
    bool try_ends(PathCourse& out, bool& ends_fit);
};

bool Search::find_ends() {
    const double total = guess.end.position;
    std::uint64_t last = pieces.first;
    while (last + 1 < pieces.count && pieces[last].end() < base + total * (1 - 1e-12)) ++last;
    begin = guess.phases[0].start.velocity == 0
                ? rest_phase(pieces[pieces.first], base, slack[0], guess.duration)
                : slow_phase(guess);
    end = {};
    if (guess.end.velocity == 0)
        end = rest_phase(pieces[last], base + total, slack[1], guess.duration);
    return begin.inner().position + end.inner().position < 0.5 * total;
}

bool Search::write(const SpeedProblem& problem, PathCourse& out) const {
    constexpr double rounding = 1e-11;
    out.count = 0;
    out.duration = 0;
    const auto state = [&](std::size_t node, double place) {
        const SpeedEnd& at = problem.at(node);
        return MotionState{place, std::sqrt(2 * at.energy), at.acceleration, 0};
    };
    if (begin.lasts > 0) {
        MotionState start = begin.from;
        start.jerk = begin.jerk;
        out.add({0, start, 0}, begin.lasts);
    }
    for (std::size_t k = 0; k < mesh.count; ++k) {
        const SpeedInterval& i = mesh.intervals[k];
        const double slope =
            (problem.at(k + 1).acceleration - problem.at(k).acceleration) / i.length;
        const PathPhase phase{0, state(k, i.begin), slope};
        const MotionState to = state(k + 1, i.begin + i.length);
        const double lasts = duration_over(phase, i.length, to.velocity);
        if (!out.add(phase, lasts) || !(lasts > 0) || !(std::abs(slope) * lasts * lasts < 4) ||
            std::abs(out.end.position - to.position) > rounding * guess.end.position)
            return false;
    }
    if (end.lasts > 0) {
        const MotionState inner = end.inner();
        out.add(
            {0,
             {guess.end.position - inner.position, inner.velocity, -inner.acceleration, end.jerk},
             0},
            end.lasts);
    }
    out.end = guess.end;
    return true;
}

/// Where a limit is exceeded between the nodes it is made tighter there; false where that is not in
/// the mesh.
bool Search::is_tightened(const PathCourse& course) {
    constexpr double more = 1.001, most = 1.2;
    const std::size_t first = begin.lasts > 0 ? 1 : 0;
    for (std::size_t k = 0; k < mesh.count; ++k)
        if (const double q = quotients[first + k]; q > 1)
            mesh.intervals[k].tight /= more * std::min(q, most);
    bool all = true;
    const auto look = [&](std::size_t phase, double& of) {
        if (!(quotients[phase] > 1)) return;
        of /= more * std::min(quotients[phase], most);
        all = false;
    };
    if (begin.lasts > 0) look(0, slack[0]);
    if (end.lasts > 0) look(course.count - 1, slack[1]);
    return all;
}

bool Search::try_ends(PathCourse& out, bool& ends_fit) {
    constexpr int most_rounds = 5;
    ends_fit = true;
    if (!find_ends()) return false;
    const MotionState first = begin.lasts > 0 ? begin.inner() : guess.phases[0].start;
    MotionState last = guess.end;
    if (end.lasts > 0) last = end.inner();
    const double total = guess.end.position;
    const double until = end.lasts > 0 ? total - last.position : total;
    if (!make_mesh(
            pieces, guess,
            {begin.lasts > 0 ? first.position : 0, until, base, factor, begin.lasts, end.lasts},
            mesh))
        return false;
    const auto energy = [](const MotionState& s) { return 0.5 * s.velocity * s.velocity; };
    SpeedProblem problem(mesh.span(), {energy(first), first.acceleration},
                         {energy(last), -last.acceleration}, {mesh.energies.data(), mesh.count});
    for (int round = 0; round < most_rounds; ++round) {
        if (!problem.solve() || !write(problem, out)) return false;
        if (keeps_limits(pieces, out, base, quotients)) return true;
        if (!is_tightened(out)) return ends_fit = false;
    }
    return false;
}

bool Search::find(PathCourse& out) {
    constexpr int most_tries = 3;
    for (int tries = 0; tries < most_tries; ++tries) {
        bool ends_fit = true;
        if (try_ends(out, ends_fit)) return true;
        if (ends_fit) return false;
    }
    return false;
}

}  // namespace

bool find_optimum(const PathPieces& pieces, const PathCourse& guess, double base, double factor,
                  PathCourse& out) {
    Search search(pieces, guess, base, factor);
    return search.find(out);
}

}  // namespace lineshaft

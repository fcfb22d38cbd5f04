#include "blocks/path/path_speed.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

namespace {

constexpr double no_limit = 1e200;

/// A direction in the plane of a corner.
struct Across {
    double cosine, sine;

    double part(const PathVector& x, const std::array<PathVector, 2>& plane) const {
        double sum = 0;
        for (std::size_t i = 0; i < path_space; ++i)
            sum += x[i] * (cosine * plane[0][i] + sine * plane[1][i]);
        return sum;
    }
};

/// The limits of the path hold for the whole vector in a corner: a polygon of 16 sides within the
/// circle.
constexpr double c1 = 0.9238795325112867, c2 = 0.7071067811865476, c3 = 0.3826834323650898;
constexpr Across polygon[] = {{1, 0}, {c1, c3},  {c2, c2},  {c3, c1},
                              {0, 1}, {-c3, c1}, {-c2, c2}, {-c1, c3}};
constexpr double polygon_share = 0.9807852804032304;  ///< cos(pi/16)

/// Calls `use(tangent, bend, twist, limit)` for all that is bounded by a limit of one kind.
template <class Use>
void each_bounded(const SpeedInterval& here, const PathPoint& x, double PathLimit::*of,
                  const Use& use) {
    if (here.kind == PathCurveKind::line) return use(1, 0, 0, here.along.*of);
    const double path = here.limits->path.*of;
    use(1, 0, 0, path);
    if (here.kind == PathCurveKind::corner && path < no_limit)
        for (const Across& side : polygon)
            use(side.part(x.tangent, here.plane), side.part(x.bend, here.plane),
                side.part(x.twist, here.plane), polygon_share * path);
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (x.tangent[i] != 0 || x.bend[i] != 0 || x.twist[i] != 0)
            use(x.tangent[i], x.bend[i], x.twist[i], here.limits->axes[i].*of);
}

}  // namespace

SpeedProblem::SpeedProblem(std::span<const SpeedInterval> intervals, const SpeedEnd& from,
                           const SpeedEnd& to, std::span<const double> energies)
    : in(intervals), n(intervals.size()) {
    for (std::size_t k = 1; k < n; ++k) {
        const double both = in[k - 1].length + in[k].length;
        weights[k] = {in[k].length / both, in[k - 1].length / both, 2 / both};
    }
    nodes[0] = from;
    nodes[n] = to;
    std::copy(energies.begin(), energies.end(), guess.begin());
    guess[0] = from.energy + 0.5 * from.acceleration * in[0].length;
    guess[n - 1] = to.energy - 0.5 * to.acceleration * in[n - 1].length;
    time = 0;
    for (std::size_t k = 0; k < n; ++k) time += in[k].length / std::sqrt(2 * guess[k]);
}

void SpeedProblem::find_nodes() {
    for (std::size_t k = 1; k < n; ++k)
        nodes[k] = {weights[k].before * b[k - 1] + weights[k].behind * b[k],
                    weights[k].rise * (b[k] - b[k - 1])};
}

void SpeedProblem::add(const Row& row) {
    if (count < rows.size()) rows[count] = row;
    ++count;
}

void SpeedProblem::add_rows_at_node(std::size_t k) {
    const double before = weights[k].before, behind = weights[k].behind, rise = weights[k].rise;
    const double fastest = std::min(in[k - 1].along.velocity, in[k].along.velocity);
    const double most = 0.5 * fastest * fastest;
    add({{before / most, behind / most, 0}, {}, 0, {}, most, true});
    const double tight = std::min(in[k - 1].tight, in[k].tight);
    const auto bounded = [&](double tangent, double bend, double, double limit) {
        if (limit >= no_limit) return;
        const double p = tangent / (tight * limit), q = 2 * bend / (tight * limit);
        add({{q * before - p * rise, q * behind + p * rise, 0}, {}, 0, {p, q, 0}, limit, false});
    };
    const bool is_line = in[k].kind == PathCurveKind::line && in[k - 1].kind != PathCurveKind::line;
    const SpeedInterval& here = is_line ? in[k - 1] : in[k];
    each_bounded(here, is_line ? here.right : here.left, &PathLimit::acceleration, bounded);
    if (is_line || in[k].limits != in[k - 1].limits)
        each_bounded(is_line ? in[k] : in[k - 1], is_line ? in[k].left : in[k - 1].right,
                     &PathLimit::acceleration, bounded);
}

void SpeedProblem::add_rows_of_jerk(std::size_t k, bool at_left) {
    const SpeedInterval& here = in[k];
    each_bounded(here, at_left ? here.left : here.right, &PathLimit::jerk,
                 [&](double tangent, double bend, double twist, double limit) {
                     if (limit >= no_limit) return;
                     add({{}, {}, 0, {tangent, bend, twist}, here.tight * limit, false});
                 });
}

/// False where there are too many.
bool SpeedProblem::find_rows() {
    count = 0;
    for (std::size_t k = 0; k < n; ++k) {
        rows_of[k].first = count;
        if (k > 0) add_rows_at_node(k);
        if (k > 0 && k + 1 < n) {
            const double most = 0.5 * in[k].along.velocity * in[k].along.velocity;
            add({{0, 1 / most, 0}, {}, 0, {}, most, true});
        }
        rows_of[k].left = count;
        add_rows_of_jerk(k, true);
        rows_of[k].right = count;
        add_rows_of_jerk(k, false);
        rows_of[k].end = count;
    }
    if (count > rows.size()) return false;
    renew_rows();
    return true;
}

/// Where b is now.
void SpeedProblem::renew_rows() {
    for (std::size_t k = 0; k < n; ++k) {
        const double w = nodes[k].energy, a = nodes[k].acceleration;
        for (std::size_t r = rows_of[k].first; r < rows_of[k].left; ++r) {
            Row& row = rows[r];
            row.value = row.is_one_sided ? w / row.limit : row.factors[0] * a + row.factors[1] * w;
        }
        if (k > 0 && k + 1 < n) {
            Row& of_middle = rows[rows_of[k].left - 1];
            of_middle.value = b[k] / of_middle.limit;
        }
        renew_rows_of_jerk(k, true);
        renew_rows_of_jerk(k, false);
    }
}

void SpeedProblem::renew_rows_of_jerk(std::size_t k, bool at_left) {
    const std::size_t at = at_left ? k : k + 1;
    const double w = nodes[at].energy, a = nodes[at].acceleration;
    const Weights &l = weights[k], &r = weights[k + 1];
    const double per = 1 / in[k].length, v = std::sqrt(2 * w), half = 0.5 / w;
    const double slope = (nodes[k + 1].acceleration - nodes[k].acceleration) * per;
    const Triple gs{l.rise * per, -(l.rise + r.rise) * per, r.rise * per};
    const Triple gw = at_left ? Triple{l.before, l.behind, 0} : Triple{0, r.before, r.behind};
    const Triple ga = at_left ? Triple{-l.rise, l.rise, 0} : Triple{0, -r.rise, r.rise};
    const Triple falls{half * gw[0], half * gw[1], half * gw[2]};
    const std::size_t first = at_left ? rows_of[k].left : rows_of[k].right;
    const std::size_t end = at_left ? rows_of[k].right : rows_of[k].end;
    for (Row& row : std::span(rows.data() + first, end - first)) {
        const double f = v / row.limit;
        const double x = f * row.factors[0], y = 3 * f * row.factors[1], z = 2 * f * row.factors[2];
        row.value = x * slope + y * a + z * w;
        row.falls = falls;
        for (std::size_t i = 0; i < 3; ++i) row.gradient[i] = x * gs[i] + y * ga[i] + z * gw[i];
    }
}

void SpeedProblem::begin() {
    const double start = 1.0 / static_cast<double>(count);
    for (std::size_t r = 0; r < count; ++r) {
        const double value = rows[r].value;
        const double first = std::max(0.1, 1 - value), other = std::max(0.1, 1 + value);
        duals[r] = {};
        duals[r].slack = {first, rows[r].is_one_sided ? 1 : other};
        duals[r].weight = {start / first, rows[r].is_one_sided ? 0 : start / other};
    }
}

/// From where the last solution was: multipliers and slacks are kept away from 0.
void SpeedProblem::begin_again() {
    find_rows();
    const double least = 1e-2 / static_cast<double>(count);
    for (std::size_t r = 0; r < count; ++r) {
        for (std::size_t side = 0; side < (rows[r].is_one_sided ? 1 : 2); ++side) {
            double &s = duals[r].slack[side], &weight = duals[r].weight[side];
            s = std::max(side == 0 ? 1 - rows[r].value : 1 + rows[r].value, 1e-3);
            weight = std::max(weight, least / s);
        }
    }
}

SpeedProblem::Progress SpeedProblem::progress() const {
    Progress out;
    for (std::size_t r = 0; r < count; ++r) {
        const Row& row = rows[r];
        const Dual& dual = duals[r];
        out.gap += dual.slack[0] * dual.weight[0] + dual.slack[1] * dual.weight[1];
        out.residual = std::max(out.residual, row.value - 1 + dual.slack[0]);
        if (!row.is_one_sided)
            out.residual = std::max(out.residual, -row.value - 1 + dual.slack[1]);
    }
    return out;
}

/// The values of k - 1, k and k + 1; 0 for those that are not there.
SpeedProblem::Triple SpeedProblem::around(const std::array<double, most_speed_intervals>& values,
                                          std::size_t k) const {
    return {k > 0 ? values[k - 1] : 0, values[k], k + 1 < n ? values[k + 1] : 0};
}

/// The matrix of the linear equations.
void SpeedProblem::assemble() {
    diagonal.fill(0), next.fill(0), second.fill(0);
    for (std::size_t k = 1; k + 1 < n; ++k) {
        const double square = 2 * b[k];
        diagonal[k] += 3 * in[k].length / (square * square * std::sqrt(square) * time);
    }
    for (std::size_t k = 0; k < n; ++k) {
        Triple d = around(diagonal, k);
        double before = k > 0 ? next[k - 1] : 0, behind = next[k], across = 0;
        for (std::size_t r = rows_of[k].first; r < rows_of[k].end; ++r) {
            Dual& dual = duals[r];
            dual.inverse = {1 / dual.slack[0], 1 / dual.slack[1]};
            const double f1 = dual.weight[0] * dual.inverse[0];
            const double f2 = dual.weight[1] * dual.inverse[1];
            const double both = f1 + f2, odd = f1 - f2;
            const Triple &g = rows[r].gradient, &e = rows[r].falls;
            Triple mg, me;
            for (std::size_t i = 0; i < 3; ++i) {
                mg[i] = both * g[i] + odd * e[i];
                me[i] = odd * g[i] + both * e[i];
            }
            for (std::size_t i = 0; i < 3; ++i) d[i] += g[i] * mg[i] + e[i] * me[i];
            before += g[0] * mg[1] + e[0] * me[1];
            behind += g[1] * mg[2] + e[1] * me[2];
            across += g[0] * mg[2] + e[0] * me[2];
        }
        diagonal[k] = d[1];
        if (k > 0) diagonal[k - 1] = d[0], next[k - 1] = before, second[k - 1] = across;
        if (k + 1 < n) diagonal[k + 1] = d[2], next[k] = behind;
    }
}

/// Of five bands, to L D L^T; both ends stay.
bool SpeedProblem::factor() {
    std::array<double, most_speed_intervals>& d = diagonal;
    for (std::size_t k = 1; k + 1 < n; ++k) {
        double one = k >= 2 ? next[k - 1] : 0;
        const double two = k >= 3 ? second[k - 2] : 0;
        if (k >= 3) {
            l2[k] = two / d[k - 2];
            one -= two * l1[k - 1];
            d[k] -= two * l2[k];
        }
        if (k >= 2) {
            l1[k] = one / d[k - 1];
            d[k] -= one * l1[k];
        }
        if (!(d[k] > 0) || !std::isfinite(d[k])) return false;
    }
    return true;
}

/// The step that leads each product of slack and multiplier to `target`, less what the product of
/// their own changes came to in the step before if that `corrects`.
template <bool corrects>
void SpeedProblem::find_step(double target) {
    right.fill(0);
    for (std::size_t k = 1; k + 1 < n; ++k) {
        const double square = 2 * b[k];
        right[k] += in[k].length / (square * std::sqrt(square) * time);
    }
    for (std::size_t k = 0; k < n; ++k) {
        Triple sum = around(right, k);
        for (std::size_t r = rows_of[k].first; r < rows_of[k].end; ++r) {
            const Row& row = rows[r];
            const Dual& dual = duals[r];
            const auto pull_of = [&](std::size_t side, double value) {
                const double s = dual.slack[side], weight = dual.weight[side];
                const double wanted = target - (corrects ? dual.product[side] : 0);
                return (wanted + weight * (value - 1 + s)) * dual.inverse[side];
            };
            const double p1 = pull_of(0, row.value);
            const double p2 = row.is_one_sided ? 0 : pull_of(1, -row.value);
            for (std::size_t i = 0; i < 3; ++i)
                sum[i] -= row.gradient[i] * (p1 - p2) + row.falls[i] * (p1 + p2);
        }
        right[k] = sum[1];
        if (k > 0) right[k - 1] = sum[0];
        if (k + 1 < n) right[k + 1] = sum[2];
    }
    solve_bands();
}

void SpeedProblem::solve_bands() {
    for (std::size_t k = 1; k + 1 < n; ++k) {
        step[k] = right[k];
        if (k >= 3) step[k] -= l2[k] * step[k - 2];
        if (k >= 2) step[k] -= l1[k] * step[k - 1];
    }
    for (std::size_t k = n - 1; k-- > 1;) {
        step[k] /= diagonal[k];
        if (k + 2 < n) step[k] -= l1[k + 1] * step[k + 1];
        if (k + 3 < n) step[k] -= l2[k + 2] * step[k + 2];
    }
    step[0] = step[n - 1] = 0;
}

/// What the step does to slacks and multipliers, and how far along it they and w stay above 0.
template <bool corrects>
SpeedProblem::Parts SpeedProblem::find_changes(double target) {
    constexpr double nearly = 0.985, least_energy = 0.2;
    Parts out;
    for (std::size_t k = 0; k < n; ++k) {
        const Triple steps = around(step, k);
        const auto along = [&](const Triple& g) {
            return g[0] * steps[0] + g[1] * steps[1] + g[2] * steps[2];
        };
        for (std::size_t r = rows_of[k].first; r < rows_of[k].end; ++r) {
            const Row& row = rows[r];
            Dual& dual = duals[r];
            const double by = along(row.gradient), fall = along(row.falls);
            for (std::size_t side = 0; side < (row.is_one_sided ? 1 : 2); ++side) {
                const double sign = side == 0 ? 1 : -1, s = dual.slack[side], w = dual.weight[side];
                const double ds = 1 - s - sign * (row.value + by) - fall;
                const double wanted = target - (corrects ? dual.product[side] : 0);
                const double dw = (wanted - w * (s + ds)) * dual.inverse[side];
                if (out.primal * ds < -nearly * s) out.primal = -nearly * s / ds;
                if (out.dual * dw < -nearly * w) out.dual = -nearly * w / dw;
                dual.slack_change[side] = ds;
                dual.weight_change[side] = dw;
            }
        }
    }
    for (std::size_t k = 1; k + 1 < n; ++k)
        if (out.primal * step[k] < (least_energy - 1) * b[k])
            out.primal = (least_energy - 1) * b[k] / step[k];
    return out;
}

/// Mehrotra's target: the better the step towards 0 would be, the nearer.
double SpeedProblem::look_ahead(double now) {
    find_step<false>(0);
    const Parts part = find_changes<false>(0);
    double then = 0;
    for (std::size_t r = 0; r < count; ++r) {
        Dual& dual = duals[r];
        for (std::size_t side = 0; side < 2; ++side) {
            const double ds = dual.slack_change[side], dw = dual.weight_change[side];
            then += (dual.slack[side] + part.primal * ds) * (dual.weight[side] + part.dual * dw);
            dual.product[side] = ds * dw;
        }
    }
    const double share = then / now;
    return share * share * share * now;
}

void SpeedProblem::go(const Parts& part) {
    for (std::size_t r = 0; r < count; ++r) {
        Dual& dual = duals[r];
        for (std::size_t side = 0; side < 2; ++side) {
            dual.slack[side] += part.primal * dual.slack_change[side];
            dual.weight[side] += part.dual * dual.weight_change[side];
        }
    }
    for (std::size_t k = 1; k + 1 < n; ++k) b[k] += part.primal * step[k];
    find_nodes();
    renew_rows();
}

/// What is next to the greatest velocity along a way is run along with exactly that.
void SpeedProblem::settle() {
    constexpr double next_to = 1e-4, same = 1e-12, rounding = 1e-15;
    for (std::size_t k = 1; k + 1 < n; ++k) {
        const double v = in[k].along.velocity, most = 0.5 * v * v;
        const bool is_even = std::abs(in[k - 1].along.velocity - v) <= same * v &&
                             std::abs(in[k + 1].along.velocity - v) <= same * v;
        if (is_even && b[k] > (1 - next_to) * most) b[k] = (1 - rounding) * most;
    }
    find_nodes();
}

/// Where no motion keeps the limits multipliers grow beyond all bounds, or steps hardly lead on.
bool SpeedProblem::iterate() {
    constexpr double near = 2e-4;     ///< to the least time, as a part of the first guess
    constexpr double hopeless = 0.2;  ///< of a gap that is not met any more
    constexpr double nearly_kept = 1e-5, far_off = 1e-2, beyond = 5, hardly = 2e-4;
    constexpr int most_steps = 32, soon = 14, most_idle = 2;
    double first = 1;
    int idle = 0;
    for (int tries = 0; tries < most_steps; ++tries) {
        const Progress now = progress();
        if (now.gap < near && now.residual < nearly_kept) return true;
        if (tries == 0) first = std::max(first, now.gap);
        if (now.gap > beyond * first || idle == most_idle || (tries >= soon && now.gap > hopeless))
            return false;
        assemble();
        if (!factor()) return false;
        const double target =
            std::max(look_ahead(now.gap), 0.1 * near) / static_cast<double>(count);
        find_step<true>(target);
        const Parts part = find_changes<true>(target);
        idle = part.primal < hardly && now.residual > far_off ? idle + 1 : 0;
        go(part);
    }
    return false;
}

/// From the last solution, or where there is none, or it does not lead on, from the guess.
bool SpeedProblem::solve() {
    bool is_found = false;
    if (is_warm) {
        begin_again();
        is_found = iterate();
    }
    if (!is_found) {
        b = guess;
        find_nodes();
        if (!find_rows()) return is_warm = false;
        begin();
        is_found = iterate();
    }
    if (is_found) settle();
    return is_warm = is_found;
}

}  // namespace lineshaft

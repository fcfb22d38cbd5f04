#include "blocks/path/path_speed.hpp"

#include <algorithm>
#include <cmath>

#include "blocks/path/path_speed_limits.hpp"

namespace lineshaft {

using namespace speed_limits;

namespace {

typedef double Sides [[gnu::vector_size(16)]];
constexpr Sides signs{1, -1};

double both(const Sides& sides) {
    return sides[0] + sides[1];
}

Sides greater_of(const Sides& a, const Sides& b) {
    return b > a ? b : a;
}

bool is_below_0(const Sides& a, const Sides& b) {
    const Sides less = b < a ? b : a;
    return less[0] < 0 || less[1] < 0;
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
    find_groups();
    time = 0;
    for (std::size_t k = 0; k < n; ++k) time += in[k].length / std::sqrt(2 * guess[k]);
}

void SpeedProblem::find_nodes() {
    for (std::size_t k = 1; k < n; ++k)
        nodes[k] = {weights[k].before * b[k - 1] + weights[k].behind * b[k],
                    weights[k].rise * (b[k] - b[k - 1])};
}

void SpeedProblem::find_groups() {
    for (std::size_t k = 0; k < n; ++k) {
        const Weights &l = weights[k], &r = weights[k + 1];
        const double per = 1 / in[k].length;
        const Triple slope{l.rise * per, -(l.rise + r.rise) * per, r.rise * per};
        const Triple rise{-l.rise, l.rise, 0}, energy{l.before, l.behind, 0};
        groups[k][at_node] = {0, 0, {}, rise, energy};
        groups[k][in_middle] = {0, 0, {}, {}, {0, 1, 0}};
        groups[k][at_left] = {0, 0, slope, rise, energy};
        groups[k][at_right] = {0, 0, slope, {0, -r.rise, r.rise}, {0, r.before, r.behind}};
    }
}

void SpeedProblem::add(double slope, double rise, double energy) {
    if (count < rows.size()) rows[count] = {slope * signs, rise * signs, energy * signs, Sides{}};
    ++count;
}

void SpeedProblem::add_velocity(double fastest) {
    add(0, 0, 2 / (fastest * fastest));
}

void SpeedProblem::add_rows_at_node(std::size_t k) {
    add_velocity(std::min(in[k - 1].along.velocity, in[k].along.velocity));
    const double tight = std::min(in[k - 1].tight, in[k].tight);
    const auto bounded = [&](double tangent, double bend, double limit) {
        add(0, tangent / (tight * limit), 2 * bend / (tight * limit));
    };
    const bool is_line = in[k].kind == PathCurveKind::line && in[k - 1].kind != PathCurveKind::line;
    const SpeedInterval& here = is_line ? in[k - 1] : in[k];
    each_acceleration(here, is_line ? here.right : here.left, bounded);
    if (is_line || in[k].limits != in[k - 1].limits)
        each_acceleration(is_line ? in[k] : in[k - 1], is_line ? in[k].left : in[k - 1].right,
                          bounded);
}

void SpeedProblem::add_rows_of_jerk(std::size_t k, Place at) {
    const SpeedInterval& here = in[k];
    each_jerk(here, at == at_left ? here.left : here.right,
              [&](double tangent, double bend, double twist, double limit) {
                  const double per = 1 / (here.tight * limit);
                  add(per * tangent, 3 * per * bend, 2 * per * twist);
              });
}

/// False where there are too many.
bool SpeedProblem::find_rows() {
    count = 0;
    for (std::size_t k = 0; k < n; ++k) {
        for (const Place place : {at_node, in_middle, at_left, at_right}) {
            Group& group = groups[k][place];
            group.first = count;
            if (place == at_node && k > 0) add_rows_at_node(k);
            if (place == in_middle && k > 0 && k + 1 < n) add_velocity(in[k].along.velocity);
            if (place == at_left || place == at_right) add_rows_of_jerk(k, place);
            group.end = count;
        }
    }
    if (count > rows.size()) return false;
    renew_rows();
    return true;
}

/// Where b is now.
void SpeedProblem::renew_rows() {
    for (std::size_t k = 0; k < n; ++k) {
        const double slope = (nodes[k + 1].acceleration - nodes[k].acceleration) / in[k].length;
        renew(groups[k][at_node], 0, nodes[k]);
        renew(groups[k][in_middle], 0, {b[k], 0});
        for (const auto& [place, node] : {std::pair{at_left, k}, {at_right, k + 1}}) {
            groups[k][place].scale = std::sqrt(2 * nodes[node].energy);
            groups[k][place].falls = 0.5 / nodes[node].energy;
            renew(groups[k][place], slope, nodes[node]);
        }
    }
}

void SpeedProblem::renew(const Group& group, double slope, const SpeedEnd& at) {
    const double x = group.scale * slope, y = group.scale * at.acceleration;
    const double z = group.scale * at.energy;
    for (Row& row : std::span(rows).subspan(group.first, group.end - group.first))
        row.value = row.slope * x + row.rise * y + row.energy * z;
}

void SpeedProblem::begin() {
    const double start = 1.0 / static_cast<double>(count);
    for (std::size_t r = 0; r < count; ++r) {
        const Sides room = 1 - rows[r].value;
        const Sides slack{std::max(0.1, room[0]), std::max(0.1, room[1])};
        duals[r].slack = slack;
        duals[r].weight = start / slack;
    }
}

/// From where the last solution was: multipliers and slacks are kept away from 0.
void SpeedProblem::begin_again() {
    find_rows();
    const double least = 1e-2 / static_cast<double>(count);
    for (std::size_t r = 0; r < count; ++r)
        for (const int side : {0, 1}) {
            duals[r].slack[side] = std::max(1 - rows[r].value[side], 1e-3);
            duals[r].weight[side] = std::max(duals[r].weight[side], least / duals[r].slack[side]);
        }
}

/// The gradient of the sum of the intervals' times, and the diagonal of its second derivatives.
void SpeedProblem::begin_bands() {
    diagonal.fill(0), next.fill(0), second.fill(0);
    for (std::size_t k = 1; k + 1 < n; ++k) {
        const double square = 2 * b[k];
        const double pull = in[k].length / (square * std::sqrt(square) * time);
        diagonal[k] = 3 * pull / square;
        least_time[k] = pull;
    }
    right = least_time;
}

/// The matrix of the linear equations, and their right side for the step towards 0.
void SpeedProblem::assemble() {
    begin_bands();
    for (std::size_t k = 0; k < n; ++k) {
        assemble<at_node>(k);
        assemble<in_middle>(k);
        assemble<at_left>(k);
        assemble<at_right>(k);
    }
}

template <SpeedProblem::Place place>
void SpeedProblem::assemble(std::size_t k) {
    const Group& group = groups[k][place];
    if (group.first == group.end) return;
    const double falls = group.falls / group.scale;
    Sides xx{}, xy{}, xz{}, yy{}, yz{}, zz{}, px{}, py{}, pz{};
    for (std::size_t r = group.first; r < group.end; ++r) {
        const Row& row = rows[r];
        Dual& dual = duals[r];
        dual.inverse = 1 / dual.slack;
        const Sides f = dual.weight * dual.inverse;
        const Sides pull = f * (row.value - 1 + dual.slack);
        const Sides x = row.slope, y = row.rise, z = row.energy + falls;
        const Sides fx = f * x, fy = f * y;
        if constexpr (place == at_left || place == at_right) {
            xx += fx * x, xy += fx * y, xz += fx * z;
            px += pull * x;
        }
        if constexpr (place != in_middle) {
            yy += fy * y, yz += fy * z;
            py += pull * y;
        }
        zz += f * z * z;
        pz += pull * z;
    }
    add_squares<place>(k, group, {both(xx), both(xy), both(xz), both(yy), both(yz), both(zz)});
    add_pulls<place>(k, group, {both(px), both(py), both(pz)});
}

/// A group's, in terms of w'', w' and w: of those of b[k-1], b[k] and b[k+1] that it knows.
template <SpeedProblem::Place place>
void SpeedProblem::add_squares(std::size_t k, const Group& group, const Squares& sums) {
    constexpr bool knows_slope = place == at_left || place == at_right;
    constexpr bool knows_before = place == at_node || knows_slope, knows_behind = knows_slope;
    const double f = group.scale * group.scale;
    const auto& [xx, xy, xz, yy, yz, zz] = sums;
    const Triple &x = group.slope, &y = group.rise, &z = group.energy;
    Triple mx{}, my{}, mz{};
    for (std::size_t i = knows_before ? 0 : 1; i < (knows_behind ? 3 : 2); ++i) {
        if constexpr (knows_slope) mx[i] = f * (xx * x[i] + xy * y[i] + xz * z[i]);
        if constexpr (place != in_middle) my[i] = f * (xy * x[i] + yy * y[i] + yz * z[i]);
        mz[i] = f * (xz * x[i] + yz * y[i] + zz * z[i]);
    }
    const auto product = [&](std::size_t i, std::size_t j) {
        if constexpr (place == in_middle) return z[i] * mz[j];
        if constexpr (place == at_node) return y[i] * my[j] + z[i] * mz[j];
        return x[i] * mx[j] + y[i] * my[j] + z[i] * mz[j];
    };
    diagonal[k] += product(1, 1);
    if (knows_before && k > 0) diagonal[k - 1] += product(0, 0), next[k - 1] += product(0, 1);
    if (knows_behind && k + 1 < n) diagonal[k + 1] += product(2, 2), next[k] += product(1, 2);
    if (knows_behind && k > 0 && k + 1 < n) second[k - 1] += product(0, 2);
}

template <SpeedProblem::Place place>
void SpeedProblem::add_pulls(std::size_t k, const Group& group, const Triple& sums) {
    constexpr bool knows_slope = place == at_left || place == at_right;
    const auto pull = [&](std::size_t i) {
        double sum = 0;
        if constexpr (knows_slope) sum = sums[0] * group.slope[i];
        if constexpr (place != in_middle) sum += sums[1] * group.rise[i];
        return group.scale * (sum + sums[2] * group.energy[i]);
    };
    right[k] -= pull(1);
    if (place != in_middle && k > 0) right[k - 1] -= pull(0);
    if (knows_slope && k + 1 < n) right[k + 1] -= pull(2);
}

/// Five bands become L D L^T; both ends stay.
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

/// The right side for the step that leads each product of slack and multiplier to `target`, less
/// what the product of their own changes came to in the step towards 0.
void SpeedProblem::correct(double target) {
    right = least_time;
    for (std::size_t k = 0; k < n; ++k) {
        correct<at_node>(k, target);
        correct<in_middle>(k, target);
        correct<at_left>(k, target);
        correct<at_right>(k, target);
    }
}

template <SpeedProblem::Place place>
void SpeedProblem::correct(std::size_t k, double target) {
    const Group& group = groups[k][place];
    if (group.first == group.end) return;
    const double falls = group.falls / group.scale;
    Sides px{}, py{}, pz{};
    for (std::size_t r = group.first; r < group.end; ++r) {
        const Row& row = rows[r];
        const Dual& dual = duals[r];
        const Sides off = row.value - 1 + dual.slack;
        const Sides pull = (target - dual.product + dual.weight * off) * dual.inverse;
        if constexpr (place == at_left || place == at_right) px += pull * row.slope;
        if constexpr (place != in_middle) py += pull * row.rise;
        pz += pull * (row.energy + falls);
    }
    add_pulls<place>(k, group, {both(px), both(py), both(pz)});
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
    constexpr double least_energy = 0.2;
    Parts out;
    for (std::size_t k = 0; k < n; ++k) {
        find_changes<corrects, at_node>(k, target, out);
        find_changes<corrects, in_middle>(k, target, out);
        find_changes<corrects, at_left>(k, target, out);
        find_changes<corrects, at_right>(k, target, out);
    }
    for (std::size_t k = 1; k + 1 < n; ++k)
        if (out.primal * step[k] < (least_energy - 1) * b[k])
            out.primal = (least_energy - 1) * b[k] / step[k];
    return out;
}

template <bool corrects, SpeedProblem::Place place>
void SpeedProblem::find_changes(std::size_t k, double target, Parts& out) {
    constexpr double nearly = 0.985;
    const Group& group = groups[k][place];
    if (group.first == group.end) return;
    const double before = k > 0 ? step[k - 1] : 0, behind = k + 1 < n ? step[k + 1] : 0;
    const auto along = [&](const Triple& g) {
        return g[0] * before + g[1] * step[k] + g[2] * behind;
    };
    const double x = place == at_left || place == at_right ? group.scale * along(group.slope) : 0;
    const double y = place != in_middle ? group.scale * along(group.rise) : 0;
    const double w = place != in_middle ? along(group.energy) : step[k];
    const double z = group.scale * w, fall = group.falls * w;
    for (std::size_t r = group.first; r < group.end; ++r) {
        const Row& row = rows[r];
        Dual& dual = duals[r];
        Sides by = row.value;
        if constexpr (place == at_left || place == at_right) by += row.slope * x;
        if constexpr (place != in_middle) by += row.rise * y;
        by += row.energy * z;
        const Sides slack = dual.slack, weight = dual.weight;
        const Sides ds = 1 - fall - slack - by;
        const Sides wanted = corrects ? target - dual.product : Sides{};
        const Sides dw = (wanted - weight * (slack + ds)) * dual.inverse;
        const Sides left = nearly * slack + out.primal * ds;
        const Sides rest = nearly * weight + out.dual * dw;
        if (is_below_0(left, rest)) [[unlikely]]
            out.shorten(nearly * slack, ds, nearly * weight, dw);
        dual.slack_change = ds;
        dual.weight_change = dw;
        if constexpr (!corrects) {
            dual.product = ds * dw;
            out.by_slack += ds * weight;
            out.by_weight += slack * dw;
            out.by_both += dual.product;
        }
    }
}

/// Mehrotra's target: the better the step towards 0 would be, the nearer.
double SpeedProblem::look_ahead(double now) {
    const Parts part = find_changes<false>(0);
    const double then = now + part.primal * both(part.by_slack) + part.dual * both(part.by_weight) +
                        part.primal * part.dual * both(part.by_both);
    const double share = then / now;
    return share * share * share * now;
}

SpeedProblem::Progress SpeedProblem::go(const Parts& part) {
    for (std::size_t k = 1; k + 1 < n; ++k) b[k] += part.primal * step[k];
    find_nodes();
    renew_rows();
    Sides gap{}, residual{};
    for (std::size_t r = 0; r < count; ++r) {
        Dual& dual = duals[r];
        dual.slack += part.primal * dual.slack_change;
        dual.weight += part.dual * dual.weight_change;
        gap += dual.slack * dual.weight;
        residual = greater_of(residual, rows[r].value - 1 + dual.slack);
    }
    return {both(gap), std::max(residual[0], residual[1])};
}

SpeedProblem::Progress SpeedProblem::progress() const {
    Sides gap{}, residual{};
    for (std::size_t r = 0; r < count; ++r) {
        gap += duals[r].slack * duals[r].weight;
        residual = greater_of(residual, rows[r].value - 1 + duals[r].slack);
    }
    return {both(gap), std::max(residual[0], residual[1])};
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
    constexpr double nearly_kept = 1e-4, far_off = 1e-2, beyond = 5, hardly = 2e-4;
    constexpr int most_steps = 32, soon = 14, most_idle = 2;
    double first = 1;
    int idle = 0;
    Progress now = progress();
    for (int tries = 0; tries < most_steps; ++tries) {
        if (now.gap < near && now.residual < nearly_kept) return true;
        if (tries == 0) first = std::max(first, now.gap);
        if (now.gap > beyond * first || idle == most_idle || (tries >= soon && now.gap > hopeless))
            return false;
        assemble();
        if (!factor()) return false;
        solve_bands();
        const double target =
            std::max(look_ahead(now.gap), 0.1 * near) / static_cast<double>(count);
        correct(target);
        solve_bands();
        const Parts part = find_changes<true>(target);
        idle = part.primal < hardly && now.residual > far_off ? idle + 1 : 0;
        now = go(part);
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

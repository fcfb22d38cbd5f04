#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "blocks/path/path_box.hpp"

namespace lineshaft {

/// A part of a way on one curve, over which w = v^2/2 is a polynomial of degree two of the way.
struct SpeedInterval {
    double begin = 0, length = 0;  ///< [u]
    const PathLimits* limits = nullptr;
    PathCurveKind kind = PathCurveKind::line;
    PathPoint left, right;              ///< the curve at both ends
    PathLimit along;                    ///< of a line; of any other curve its velocity alone
    std::array<PathVector, 2> plane{};  ///< of a corner: two directions upright on each other
    double tight = 1;  ///< so much of the limits of acceleration and jerk counts, 0..1
};

/// w' is the acceleration.
struct SpeedEnd {
    double energy = 0, acceleration = 0;  ///< w > 0 [u^2/s^2], w' [u/s^2]
};

inline constexpr std::size_t most_speed_intervals = 180;

/// How a way is run along in the least time between two ends, within the limits at both ends of
/// each interval (README.md, "The least time"): an interior point method, in the unknown control
/// points of w. A second solution for other values of `tight` begins from the one before.
class SpeedProblem {
  public:
    /// At most `most_speed_intervals`, at least 3, which outlive this. `energies` are w in the
    /// middle of each, more or less, above 0.
    SpeedProblem(std::span<const SpeedInterval> intervals, const SpeedEnd& from, const SpeedEnd& to,
                 std::span<const double> energies);

    /// False where none is found.
    bool solve();

    /// Where intervals meet, 0 to their number.
    const SpeedEnd& at(std::size_t node) const { return nodes[node]; }

    static constexpr std::size_t most_rows = 18 * most_speed_intervals;

  private:
    using Triple = std::array<double, 3>;

    /// Both sides of a row, -1 and 1.
    typedef double Sides [[gnu::vector_size(16)]];

    /// A linear function of w'', w' and w that is to stay within -1 and 1, and its negative.
    struct Row {
        Sides slope, rise, energy;  ///< by w'', w' and w
        Sides value;
    };

    /// Rows that know w'', w' and w of one place, linear functions of b[k-1], b[k] and b[k+1]. What
    /// they say is multiplied by `scale`; their bounds become less by `falls` times what w rises.
    struct Group {
        std::size_t first = 0, end = 0;
        Triple slope{}, rise{}, energy{};
        double scale = 1, falls = 0;
    };
    using Squares = std::array<double, 6>;
    enum Place : std::size_t { at_node, in_middle, at_left, at_right, places };

    /// Slack and multiplier of both sides of a row, what a step changes them by, and the product of
    /// those changes.
    struct Dual {
        Sides slack, weight, inverse, slack_change, weight_change, product;
    };

    /// How far along a step, and what the sum of slacks times multipliers becomes by `primal`, by
    /// `dual` and by their product.
    struct Parts {
        double primal = 1, dual = 1;
        Sides by_slack{}, by_weight{}, by_both{};

        /// So that what changes by ds and dw does not fall below 0.
        void shorten(const Sides& slack, const Sides& ds, const Sides& weight, const Sides& dw) {
            for (const int side : {0, 1}) {
                if (slack[side] + primal * ds[side] < 0)
                    primal = std::min(primal, -slack[side] / ds[side]);
                if (weight[side] + dual * dw[side] < 0)
                    dual = std::min(dual, -weight[side] / dw[side]);
            }
        }
    };

    /// How far from the least time and from the limits.
    struct Progress {
        double gap = 0;       ///< the sum of slacks times multipliers
        double residual = 0;  ///< by how much a row is off at most
    };

    /// What node k is by b[k-1] and b[k]: w = before b[k-1] + behind b[k], w' = rise (b[k] -
    /// b[k-1]). All 0 at the ends.
    struct Weights {
        double before = 0, behind = 0, rise = 0;
    };

    std::span<const SpeedInterval> in;
    std::size_t n;
    double time = 1;  ///< of the first guess [s]
    std::array<SpeedEnd, most_speed_intervals + 1> nodes{};
    std::array<Weights, most_speed_intervals + 1> weights{};
    std::array<double, most_speed_intervals> guess{}, b{}, step{}, diagonal{}, next{}, second{},
        least_time{}, right{}, l1{}, l2{};
    std::array<Row, most_rows> rows;
    std::array<Dual, most_rows> duals;
    std::array<std::array<Group, places>, most_speed_intervals> groups{};
    std::size_t count = 0;
    bool is_warm = false;

    void find_nodes();
    void find_groups();
    bool find_rows();
    void add(double slope, double rise, double energy);
    void add_velocity(double fastest);
    void add_rows_at_node(std::size_t k);
    void add_rows_of_jerk(std::size_t k, Place at);
    void renew_rows();
    void renew(const Group& group, double slope, const SpeedEnd& at);
    void begin();
    void begin_again();
    void begin_bands();
    void assemble();
    template <Place place>
    void assemble(std::size_t k);
    template <Place place>
    void add_squares(std::size_t k, const Group& group, const Squares& sums);
    template <Place place>
    void add_pulls(std::size_t k, const Group& group, const Triple& sums);
    bool factor();
    void correct(double target);
    template <Place place>
    void correct(std::size_t k, double target);
    void solve_bands();
    template <bool corrects>
    Parts find_changes(double target);
    template <bool corrects, Place place>
    void find_changes(std::size_t k, double target, Parts& out);
    double look_ahead(double now);
    Progress go(const Parts& part);
    Progress progress() const;
    void settle();
    bool iterate();
};

}  // namespace lineshaft

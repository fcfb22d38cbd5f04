#pragma once

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

    /// A linear function of b[k-1], b[k], b[k+1] that is to stay within -1 and 1, or below 1; where
    /// `falls` is not 0 that bound becomes less as w rises.
    struct Row {
        Triple gradient{}, falls{};
        double value = 0;
        Triple factors{};  ///< of what is limited in terms of w and its derivatives
        double limit = 0;  ///< of that
        bool is_one_sided = false;
    };

    /// The rows of one k, one behind the other.
    struct Rows {
        std::size_t first = 0;                     ///< of node k and of b[k]
        std::size_t left = 0, right = 0, end = 0;  ///< of the jerk at both ends of interval k
    };

    /// Slack and multiplier of both sides of a row, what a step changes them by, and the product of
    /// those changes.
    struct Dual {
        std::array<double, 2> slack{}, weight{}, inverse{}, slack_change{}, weight_change{},
            product{};
    };

    /// How far along a step.
    struct Parts {
        double primal = 1, dual = 1;
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
        right{}, l1{}, l2{};
    std::array<Row, most_rows> rows;
    std::array<Dual, most_rows> duals;
    std::array<Rows, most_speed_intervals> rows_of{};
    std::size_t count = 0;
    bool is_warm = false;

    void find_nodes();
    bool find_rows();
    void add(const Row& row);
    void add_rows_at_node(std::size_t k);
    void add_rows_of_jerk(std::size_t k, bool at_left);
    void renew_rows();
    void renew_rows_of_jerk(std::size_t k, bool at_left);
    void begin();
    void begin_again();
    Progress progress() const;
    void assemble();
    bool factor();
    void solve_bands();
    template <bool corrects>
    void find_step(double target);
    template <bool corrects>
    Parts find_changes(double target);
    double look_ahead(double now);
    void go(const Parts& part);
    void settle();
    bool iterate();
    Triple around(const std::array<double, most_speed_intervals>& values, std::size_t k) const;
};

}  // namespace lineshaft

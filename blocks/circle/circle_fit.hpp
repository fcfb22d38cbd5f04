#pragma once

#include <array>
#include <span>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// How good a circle is, from its samples while `enable` is true; a rising edge begins anew.
///
/// Centre by algebraic least squares, running: x^2 + y^2 = 2 xc x + 2 yc y + c (Wei et al. 2025,
/// ref. [11]); before three samples that span a circle the wanted centre stands. offset D =
/// |estimated - wanted centre| (19). Deviation of a sample: | |P - wanted centre| - R |;
/// mean_deviation is its mean, the paper's MSE (20). A sample that is no number, or farther than
/// 10^9 radii away, is left out.
struct CircleFit {
    double radius = 20, x0 = 0, y0 = 0;

    bool enable = false;
    double x = 0, y = 0;

    double mean_deviation = 0, largest_deviation = 0, worst_x = 0, worst_y = 0, worst_x_share = 0;
    double centre_x = 0, centre_y = 0, offset = 0, fitted_radius = 0;
    double closing_gap = 0;
    std::int64_t samples = 0;

    double first_x = 0, first_y = 0, deviation_sum = 0;
    /// Sums over samples, relative to the wanted centre, in radii: u u, u v, v v, u, v, u w, v w,
    /// w; w = u u + v v.
    std::array<double, 8> sums{};
    bool taking = false;  ///< enabled, and the first sample has been taken

    static constexpr std::string_view type = "circle_fit";
    static constexpr std::string_view doc = "centre, offset and deviations of a circle's samples";
    static std::span<const Field> fields();
    void scan(const Scan& now);

  private:
    void begin();
    void add();
    void solve();
};

}  // namespace lineshaft

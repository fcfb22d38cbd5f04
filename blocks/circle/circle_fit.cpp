#include "blocks/circle/circle_fit.hpp"

#include <algorithm>
#include <cmath>

namespace lineshaft {

namespace {

constexpr double farthest = 1e9;  // [radii] of a sample: sums of squares of squares stay numbers

}  // namespace

std::span<const Field> CircleFit::fields() {
    using F = CircleFit;
    static const Field table[] = {
        parameter("radius", &F::radius, "mm", "wanted radius R").above(0).must_be_set(),
        parameter("x0", &F::x0, "mm", "wanted centre"),
        parameter("y0", &F::y0, "mm", "wanted centre"),
        input("enable", &F::enable, "", "take samples").must_be_set(),
        input("x", &F::x, "mm", "sample").must_be_set(),
        input("y", &F::y, "mm", "sample").must_be_set(),
        output("mean_deviation", &F::mean_deviation, "mm", "mean of | |P| - R |, the paper's MSE"),
        output("largest_deviation", &F::largest_deviation, "mm", "greatest of | |P| - R |"),
        output("worst_x", &F::worst_x, "mm", "where the deviation was largest"),
        output("worst_y", &F::worst_y, "mm", "where the deviation was largest"),
        output("worst_x_share", &F::worst_x_share, "",
               "|worst_x - x0| / R: 1 on the circle's left or right"),
        output("centre_x", &F::centre_x, "mm", "estimated centre"),
        output("centre_y", &F::centre_y, "mm", "estimated centre"),
        output("offset", &F::offset, "mm", "D, estimated to wanted centre"),
        output("fitted_radius", &F::fitted_radius, "mm", "of the estimated circle"),
        output("closing_gap", &F::closing_gap, "mm", "first sample to where the path ended"),
        output("samples", &F::samples, "", "taken since the rising edge"),
    };
    return table;
}

void CircleFit::scan(const Scan&) {
    const bool sample =
        std::abs(x - x0) <= farthest * radius && std::abs(y - y0) <= farthest * radius;
    if (sample && enable && !taking) begin();
    if (sample && enable) add();
    if (sample && (enable || taking))
        closing_gap = std::sqrt((x - first_x) * (x - first_x) + (y - first_y) * (y - first_y));
    taking = enable && (sample || taking);
}

void CircleFit::begin() {
    sums = {};
    samples = 0;
    deviation_sum = largest_deviation = 0;
    first_x = x;
    first_y = y;
}

void CircleFit::add() {
    const double u = (x - x0) / radius, v = (y - y0) / radius, w = u * u + v * v;
    const std::array<double, 8> terms{u * u, u * v, v * v, u, v, u * w, v * w, w};
    for (std::size_t i = 0; i < terms.size(); ++i) sums[i] += terms[i];
    ++samples;
    const double deviation = std::abs(std::sqrt(w) - 1) * radius;
    deviation_sum += deviation;
    mean_deviation = deviation_sum / static_cast<double>(samples);
    if (samples == 1 || deviation > largest_deviation) {
        largest_deviation = deviation;
        worst_x = x;
        worst_y = y;
        worst_x_share = std::abs(u);
    }
    solve();
}

void CircleFit::solve() {
    const auto& [uu, uv, vv, u, v, uw, vw, w] = sums;
    const double n = static_cast<double>(samples), mean_u = u / n, mean_v = v / n;
    const double suu = uu - u * mean_u, suv = uv - u * mean_v, svv = vv - v * mean_v;
    const double suw = uw - w * mean_u, svw = vw - w * mean_v;
    const double determinant = suu * svv - suv * suv;
    const double spread = std::max(suu, svv), rounding = 1e-12 * std::max(uu + vv, n);
    double a = 0, b = 0, c = 1;
    if (spread > 0 && determinant > spread * rounding) {
        a = (suw * svv - svw * suv) / determinant / 2;
        b = (svw * suu - suw * suv) / determinant / 2;
        c = w / n - 2 * (a * mean_u + b * mean_v);
    }
    centre_x = x0 + a * radius;
    centre_y = y0 + b * radius;
    offset = std::sqrt(a * a + b * b) * radius;
    fitted_radius = std::sqrt(std::max(0.0, c + a * a + b * b)) * radius;
}

}  // namespace lineshaft

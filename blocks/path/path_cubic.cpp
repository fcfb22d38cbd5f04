#include "blocks/path/path_cubic.hpp"

#include <array>

namespace lineshaft {

namespace {

constexpr std::size_t most_knots = 2 * cubic_reach + 1;

PathVector slope(const PathVector& a, const PathVector& b, double width) {
    PathVector out{};
    for (std::size_t i = 0; i < most_path_axes; ++i) out[i] = (b[i] - a[i]) / width;
    return out;
}

}  // namespace

PathPoint PathKnot::point() const {
    PathPoint out;
    out.position = position;
    const double size = distance({}, first);
    for (std::size_t i = 0; i < most_path_axes; ++i) out.tangent[i] = first[i] / size;
    return out;
}

PathKnot knot_of(std::span<const PathVector> points, std::size_t at) {
    const std::size_t last = points.size() - 1;
    std::array<double, most_knots> width{}, diagonal{};
    std::array<PathVector, most_knots> slopes{}, second{};
    for (std::size_t k = 0; k < last; ++k) {
        width[k] = distance(points[k], points[k + 1]);
        slopes[k] = slope(points[k], points[k + 1], width[k]);
    }
    // Elimination forwards, then second derivatives backwards.
    for (std::size_t k = 1; k < last; ++k) {
        const double factor = k == 1 ? 0 : width[k - 1] / diagonal[k - 1];
        diagonal[k] = 2 * (width[k - 1] + width[k]) - factor * width[k - 1];
        for (std::size_t i = 0; i < most_path_axes; ++i)
            second[k][i] = 6 * (slopes[k][i] - slopes[k - 1][i]) - factor * second[k - 1][i];
    }
    for (std::size_t k = last; k-- > 1;)
        for (std::size_t i = 0; i < most_path_axes; ++i)
            second[k][i] = (second[k][i] - width[k] * second[k + 1][i]) / diagonal[k];
    PathKnot out{points[at], {}, second[at]};
    for (std::size_t i = 0; i < most_path_axes; ++i)
        out.first[i] =
            at < last
                ? slopes[at][i] - width[at] * (2 * second[at][i] + second[at + 1][i]) / 6
                : slopes[at - 1][i] + width[at - 1] * (second[at - 1][i] + 2 * second[at][i]) / 6;
    return out;
}

std::size_t cubic_between(const PathKnot& from, const PathKnot& to,
                          std::span<PathCurve, most_spline_parts> out) {
    const double width = distance(from.position, to.position);
    const auto scaled = [&](const PathKnot& knot) {
        PathPoint point;
        point.position = knot.position;
        for (std::size_t i = 0; i < most_path_axes; ++i) {
            point.tangent[i] = width * knot.first[i];
            point.bend[i] = width * width * knot.second[i];
        }
        return point;
    };
    return quintic_between(scaled(from), scaled(to), out);
}

}  // namespace lineshaft

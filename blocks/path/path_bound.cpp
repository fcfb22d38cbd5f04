#include "blocks/path/path_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "blocks/path/path_polynomial.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t count_of_sizes = std::tuple_size_v<PathPolynomial>;

/// Over a curve's parameter, of which the length is a polynomial: the sizes of its derivatives, the
/// k-th in place k.
using Sizes = std::array<double, count_of_sizes>;

/// Within `half` of `middle` no derivative is greater than the sum of the sizes of its Taylor
/// series there.
Sizes greatest_within(PathPolynomial p, double middle, double half) {
    Sizes at{}, out{};
    for (std::size_t k = 0; k < count_of_sizes; ++k) {
        at[k] = std::abs(value_of(p, middle));
        p = derivative_of(p);
    }
    for (std::size_t k = 0; k < count_of_sizes; ++k) {
        double scale = 1;
        for (std::size_t i = k; i < count_of_sizes; ++i) {
            out[k] += at[i] * scale;
            scale *= half / static_cast<double>(i - k + 1);
        }
    }
    return out;
}

/// Bounds x(m(s)) by the sizes of the derivatives of both (Faa di Bruno).
PathBound composed(const Sizes& x, const Sizes& m) {
    const double a = m[1], b = m[2], c = m[3], d = m[4], e = m[5];
    return {x[1] * a, x[2] * a * a + x[1] * b, x[3] * a * a * a + 3 * x[2] * a * b + x[1] * c,
            x[4] * a * a * a * a + 6 * x[3] * a * a * b + x[2] * (3 * b * b + 4 * a * c) + x[1] * d,
            x[5] * a * a * a * a * a + 10 * x[4] * a * a * a * b +
                x[3] * (15 * a * b * b + 10 * a * a * c) + x[2] * (10 * b * c + 5 * a * d) +
                x[1] * e};
}

PathBound greater_of(const PathBound& a, const PathBound& b) {
    return {std::max(a.tangent, b.tangent), std::max(a.bend, b.bend), std::max(a.twist, b.twist),
            std::max(a.fourth, b.fourth), std::max(a.fifth, b.fifth)};
}

/// A sixteenth of a spline.
struct SplinePart {
    double middle = 0, half = 0;  ///< of its parameter
    Sizes map;                    ///< by the length
};

constexpr std::size_t spline_parts = 16;

std::array<SplinePart, spline_parts> parts_of_spline(const PathCurve& c) {
    constexpr double half = 0.5 / spline_parts;
    std::array<SplinePart, spline_parts> out;
    for (std::size_t k = 0; k < spline_parts; ++k) {
        const double middle = (static_cast<double>(k) + 0.5) / spline_parts;
        out[k].map = greatest_within(c.map, middle, half);
        double per = 1;
        for (double& size : out[k].map) {
            size *= per;
            per /= c.length;
        }
        out[k].middle = value_of(c.map, middle);
        out[k].half = out[k].map[1] * half * c.length;
    }
    return out;
}

PathBound bound_of_spline(const PathCurve& c, std::size_t axis,
                          const std::array<SplinePart, spline_parts>& parts) {
    const PathPolynomial x{c.origin[axis], c.u[axis],      c.w[axis],
                           c.slope[axis],  c.fourth[axis], c.fifth[axis]};
    PathBound out;
    if (!c.moves(axis)) return out;
    for (const SplinePart& part : parts)
        out = greater_of(out, composed(greatest_within(x, part.middle, part.half), part.map));
    return out;
}

/// h = 3 t^2 - 2 t^3 times `turn`, t = s / length.
PathBound bound_of_turn(double tangent, double turn, double length) {
    if (turn == 0) return {tangent, 0, 0, 0, 0};
    const double square = length * length;
    return {tangent, 1.5 * turn / length, 6 * turn / square, 12 * turn / (square * length), 0};
}

}  // namespace

PathBound bound_of(const PathCurve& curve, std::size_t axis) {
    const double u = curve.u[axis], w = curve.w[axis];
    switch (curve.kind) {
        case PathCurveKind::line:
            return {std::abs(u), 0, 0, 0, 0};
        case PathCurveKind::arc: {
            const double m = std::hypot(u, w), per = 1 / curve.radius;
            return {m + std::abs(curve.slope[axis]), m * per, m * per * per, m * per * per * per,
                    m * per * per * per * per};
        }
        case PathCurveKind::corner:
            return bound_of_turn(std::max(std::abs(u), std::abs(w)), std::abs(w - u), curve.length);
        case PathCurveKind::spline:
            return bound_of_spline(curve, axis, parts_of_spline(curve));
    }
    return {};
}

PathBounds bounds_of(const PathCurve& curve) {
    PathBounds out;
    const bool is_spline = curve.kind == PathCurveKind::spline;
    std::array<SplinePart, spline_parts> parts;
    if (is_spline) parts = parts_of_spline(curve);
    for (std::size_t i = 0; i < most_path_axes; ++i)
        out[i] = is_spline ? bound_of_spline(curve, i, parts) : bound_of(curve, i);
    return out;
}

PathBound bound_of_corner(const PathCurve& corner) {
    double square = 0;
    for (std::size_t i = 0; i < path_space; ++i)
        square += (corner.w[i] - corner.u[i]) * (corner.w[i] - corner.u[i]);
    return bound_of_turn(1, std::sqrt(square), corner.length);
}

}  // namespace lineshaft

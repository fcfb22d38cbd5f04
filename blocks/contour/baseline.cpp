#include "blocks/contour/baseline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "blocks/path/path_polynomial.hpp"

namespace lineshaft {

namespace {

double length(double x, double y) {
    return std::sqrt(x * x + y * y);
}

double segment_distance(Point a, Point b, Point p) {
    const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
    const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
    const double t = squared > 0 ? std::clamp(along / squared, 0.0, 1.0) : 0;
    return length(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

/// Where g changes its sign between `low` and `high`, by halves.
double crossing(const PathPolynomial& g, double low, double high) {
    const bool rises = value_of(g, low) < 0;
    for (int i = 0; i < std::numeric_limits<double>::digits; ++i) {
        const double middle = (low + high) / 2;
        ((value_of(g, middle) < 0) == rises ? low : high) = middle;
    }
    return high;
}

/// Where a polynomial is zero or changes its sign for t = 0 .. 1, in order. Between two such places
/// of its derivative it is monotone and so changes it once at most.
struct Crossings {
    std::array<double, 5> at{};
    std::size_t count = 0;

    explicit Crossings(const PathPolynomial& g, int degree = 5) {
        if (degree == 0) return;
        const Crossings turns(derivative_of(g), degree - 1);
        double low = 0;
        for (std::size_t i = 0; i <= turns.count; ++i) {
            const double high = i < turns.count ? turns.at[i] : 1;
            if (!(value_of(g, low) * value_of(g, high) > 0)) at[count++] = crossing(g, low, high);
            low = high;
        }
    }
};

double span_distance(const SplineSpan& span, Point p) {
    const auto& c = span.c;
    const auto deviation = [&](double t) {
        const Point s = span.at(t);
        return length(s.x - p.x, s.y - p.y);
    };
    PathPolynomial g{};  // of (s - p) s'
    for (std::size_t i = 0; i < 4; ++i) {
        const Point s{c[i].x - (i == 0 ? p.x : 0), c[i].y - (i == 0 ? p.y : 0)};
        for (std::size_t k = 1; k < 4; ++k)
            g[i + k - 1] += static_cast<double>(k) * (s.x * c[k].x + s.y * c[k].y);
    }
    double least = std::min(deviation(0), deviation(1));
    const Crossings stationary(g);
    for (std::size_t i = 0; i < stationary.count; ++i)
        least = std::min(least, deviation(stationary.at[i]));
    return least;
}

}  // namespace

double polyline_distance(std::span<const Point> points, std::size_t nearest, Point p) {
    double least = length(p.x - points[nearest].x, p.y - points[nearest].y);
    if (nearest > 0)
        least = std::min(least, segment_distance(points[nearest - 1], points[nearest], p));
    if (nearest + 1 < points.size())
        least = std::min(least, segment_distance(points[nearest], points[nearest + 1], p));
    return least;
}

Point SplineSpan::at(double t) const {
    return {c[0].x + t * (c[1].x + t * (c[2].x + t * c[3].x)),
            c[0].y + t * (c[1].y + t * (c[2].y + t * c[3].y))};
}

/// h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (slope[i] - slope[i-1]), m = s''.
/// Until the last loop, c[1].x of a span is its h, c[2] the m at its beginning, c[3].x its pivot.
void natural_spline(std::span<const Point> points, std::span<SplineSpan> spans) {
    const std::size_t n = spans.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Point a = points[i], b = points[i + 1];
        spans[i] = {{a, {length(b.x - a.x, b.y - a.y), 0}, {}, {}}};
    }
    for (std::size_t i = 1; i < n; ++i) {
        const Point a = points[i - 1], b = points[i], d = points[i + 1];
        auto& [c0, c1, m, pivot] = spans[i].c;
        const auto& [p0, p1, last_m, last_pivot] = spans[i - 1].c;
        const double before = p1.x, after = c1.x, w = i > 1 ? before / last_pivot.x : 0;
        pivot.x = 2 * (before + after) - w * before;
        m.x = 6 * ((d.x - b.x) / after - (b.x - a.x) / before) - w * last_m.x;
        m.y = 6 * ((d.y - b.y) / after - (b.y - a.y) / before) - w * last_m.y;
    }
    Point next{};
    for (std::size_t i = n; i-- > 1;) {
        auto& [c0, c1, m, pivot] = spans[i].c;
        next = m = {(m.x - c1.x * next.x) / pivot.x, (m.y - c1.x * next.y) / pivot.x};
    }
    for (std::size_t i = 0; i < n; ++i) {
        auto& [c0, c1, c2, c3] = spans[i].c;
        const Point end = points[i + 1], m0 = c2, m1 = i + 1 < n ? spans[i + 1].c[2] : Point{};
        const double h2 = c1.x * c1.x;
        c1 = {end.x - c0.x - (2 * m0.x + m1.x) * h2 / 6, end.y - c0.y - (2 * m0.y + m1.y) * h2 / 6};
        c2 = {m0.x * h2 / 2, m0.y * h2 / 2};
        c3 = {(m1.x - m0.x) * h2 / 6, (m1.y - m0.y) * h2 / 6};
    }
}

double spline_distance(std::span<const SplineSpan> spans, std::size_t nearest, Point p) {
    double least = std::numeric_limits<double>::infinity();
    if (nearest > 0) least = span_distance(spans[nearest - 1], p);
    if (nearest < spans.size()) least = std::min(least, span_distance(spans[nearest], p));
    return least;
}

}  // namespace lineshaft

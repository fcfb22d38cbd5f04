#include "blocks/path/path_spline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <sleef.h>

#include "blocks/path/path_integral.hpp"
#include "blocks/path/path_polynomial.hpp"

namespace lineshaft {

double distance(const PathVector& a, const PathVector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < path_space; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
}

namespace {

using Polynomial = PathPolynomial;

Polynomial polynomial_of(const PathCurve& c, std::size_t axis) {
    return {c.origin[axis], c.u[axis], c.w[axis], c.slope[axis], c.fourth[axis], c.fifth[axis]};
}

/// p(at + width t).
Polynomial part_of(Polynomial p, double at, double width) {
    Polynomial out{};
    double scale = 1;
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k] = value_of(p, at) * scale;
        p = derivative_of(p);
        scale *= width / static_cast<double>(k + 1);
    }
    return out;
}

/// It is of degree five, with value, slope and second derivative at 0 and at 1.
Polynomial hermite(double p0, double d0, double b0, double p1, double d1, double b1) {
    const double P = p1 - p0 - d0 - 0.5 * b0, D = d1 - d0 - b0, B = b1 - b0;
    return {
        p0, d0, 0.5 * b0, 10 * P - 4 * D + 0.5 * B, -15 * P + 7 * D - B, 6 * P - 3 * D + 0.5 * B};
}

double along(const PathVector& a, const PathVector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < path_space; ++i) sum += a[i] * b[i];
    return sum;
}

void set(PathCurve& c, std::size_t axis, const Polynomial& p) {
    c.origin[axis] = p[0];
    c.u[axis] = p[1];
    c.w[axis] = p[2];
    c.slope[axis] = p[3];
    c.fourth[axis] = p[4];
    c.fifth[axis] = p[5];
}

/// The first three axes' way by t: its first derivative, and the product of first and second.
struct Pace {
    double speed = 0, change = 0;
};

Pace pace_at(const PathCurve& c, double t) {
    double square = 0, product = 0;
    for (std::size_t i = 0; i < path_space; ++i) {
        const Polynomial first = derivative_of(polynomial_of(c, i));
        const double x = value_of(first, t);
        square += x * x;
        product += x * value_of(derivative_of(first), t);
    }
    return {std::sqrt(square), product};
}

double length_of(const PathCurve& c) {
    return integral_until(1, [&](double t) { return pace_at(c, t).speed; });
}

/// t by the length: with the right first and second derivative at both ends.
void find_map(PathCurve& c) {
    const Pace a = pace_at(c, 0), b = pace_at(c, 1);
    const auto bend = [&](const Pace& pace) {
        const double square = pace.speed * pace.speed;
        return -pace.change / (square * square) * c.length * c.length;
    };
    c.map = hermite(0, c.length / a.speed, bend(a), 1, c.length / b.speed, bend(b));
}

/// How far |x'| is from 1 at most; NaN where it is not finite somewhere.
double unevenness(const PathCurve& c) {
    constexpr int places = 33;
    const Polynomial slope = derivative_of(c.map);
    double most = 0;
    for (int k = 0; k < places; ++k) {
        const double share = static_cast<double>(k) / (places - 1);
        const double tangent =
            pace_at(c, value_of(c.map, share)).speed * value_of(slope, share) / c.length;
        if (!(std::abs(tangent - 1) <= most)) most = std::abs(tangent - 1);
    }
    return most;
}

/// With x, x' and x'' by t at both ends.
PathCurve quintic(const PathPoint& from, const PathPoint& to) {
    PathCurve c;
    c.kind = PathCurveKind::spline;
    for (std::size_t i = 0; i < most_path_axes; ++i)
        set(c, i,
            hermite(from.position[i], from.tangent[i], from.bend[i], to.position[i], to.tangent[i],
                    to.bend[i]));
    c.end = to.position;
    return c;
}

PathPoint scaled(PathPoint point, double scale) {
    for (double& x : point.tangent) x *= scale;
    for (double& x : point.bend) x *= scale * scale;
    return point;
}

/// `scale`, or what is left of it where the curvature is great: beyond a few radii the second
/// derivative would lead the curve far out of its points.
double scale_at(const PathPoint& point, double scale) {
    constexpr double most_radii = 3;
    const double curvature = std::sqrt(along(point.bend, point.bend));
    return curvature * scale > most_radii ? most_radii / curvature : scale;
}

PathCurve quintic(const PathPoint& from, const PathPoint& to, double scale) {
    return quintic(scaled(from, scale_at(from, scale)), scaled(to, scale_at(to, scale)));
}

/// From t = `at` on, of the width `width`.
PathCurve part(const PathCurve& whole, double at, double width) {
    PathCurve c = whole;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const Polynomial p = polynomial_of(whole, i);
        set(c, i, part_of(p, at, width));
        if (at + width < 1) c.end[i] = value_of(p, at + width);
    }
    c.length = length_of(c);
    if (c.length > 0) find_map(c);
    return c;
}

/// Into halves, quarters and so on, where they are not as even as that; 0 where there would be too
/// many. From the first one on, with what is behind it waiting.
std::size_t divide(const PathCurve& whole, double most_uneven,
                   std::span<PathCurve, most_spline_parts> out) {
    std::array<double, most_spline_parts> widths{1.0};
    std::size_t count = 0, waiting = 1;
    for (double at = 0; waiting > 0;) {
        double& width = widths[waiting - 1];
        out[count] = part(whole, at, width);
        if (out[count].length > 0 && unevenness(out[count]) <= most_uneven) {
            at += width;
            ++count;
            --waiting;
            continue;
        }
        if (count + waiting == out.size()) return 0;
        width *= 0.5;
        widths[waiting++] = width;
    }
    return count;
}

/// A part of a line or of an arc, from one length of it to another.
struct Part {
    const PathCurve& curve;
    double from = 0, to = 0;
    PathVector begin = curve.at(from).position, end = curve.at(to).position;

    /// How far a point is from the nearest one of the part.
    double distance_to(const PathVector& x) const {
        PathVector off{};
        for (std::size_t i = 0; i < path_space; ++i) off[i] = x[i] - curve.origin[i];
        const double u = along(off, curve.u), w = along(off, curve.w);
        const bool arc = curve.kind == PathCurveKind::arc;
        const double angle = arc ? Sleef_cinz_atan2d1_u10purec(w, u) : 0;
        const double s = arc ? curve.radius * (angle < 0 ? angle + 2 * std::numbers::pi : angle)
                             : u / along(curve.u, curve.u);
        const double ends = std::min(distance(x, begin), distance(x, end));
        return s > from && s < to ? std::min(ends, distance(x, curve.at(s).position)) : ends;
    }
};

/// The greatest of f(t) for t in 0..1: of 33 places, and around the greatest of these.
template <class Function>
double greatest_of(Function f) {
    constexpr int places = 32, steps = 12;
    double at = 0, most = f(0.0);
    for (int k = 1; k <= places; ++k) {
        const double t = static_cast<double>(k) / places;
        if (const double here = f(t); here > most) at = t, most = here;
    }
    double a = std::max(0.0, at - 1.0 / places), b = std::min(1.0, at + 1.0 / places);
    for (int step = 0; step < steps; ++step) {
        const double c = a + (b - a) / 3, d = b - (b - a) / 3, at_c = f(c), at_d = f(d);
        most = std::max({most, at_c, at_d});
        (at_c > at_d ? b : a) = at_c > at_d ? d : c;
    }
    return most;
}

/// Between two points, by t from 0 to 1 and with tangents as long as it is.
PathCurve whole_between(const PathPoint& from, const PathPoint& to) {
    double scale = distance(from.position, to.position);
    for (int step = 0; step < 2; ++step) scale = length_of(quintic(from, to, scale));
    return quintic(from, to, scale);
}

/// How far the transition that begins and ends `far` from the joint passes it, or is away from what
/// it is put in for: whichever is more, and a hundredth.
double deviation_of(const PathCurve& before, const PathCurve& after, double far) {
    const Part left{before, before.length - far, before.length}, right{after, 0, far};
    const PathCurve c = whole_between(before.at(left.from), after.at(right.to));
    const auto place = [&](double t) {
        PathVector x{};
        for (std::size_t i = 0; i < path_space; ++i) x[i] = value_of(polynomial_of(c, i), t);
        return x;
    };
    const double off = greatest_of([&](double t) {
        const PathVector x = place(t);
        return std::min(left.distance_to(x), right.distance_to(x));
    });
    const double passing = -greatest_of([&](double t) { return -distance(place(t), left.end); });
    return 1.01 * std::max(off, passing);
}

constexpr double as_even_as_can_be = 1e-2;

/// By the length, where the curve's own parameter is t.
PathPoint point_at(const PathCurve& c, double t) {
    const Pace pace = pace_at(c, t);
    const double square = pace.speed * pace.speed;
    PathPoint out;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const Polynomial p = polynomial_of(c, i), first = derivative_of(p);
        const double x = value_of(first, t);
        out.position[i] = t < 1 ? value_of(p, t) : c.end[i];
        out.tangent[i] = x / pace.speed;
        out.bend[i] = (value_of(derivative_of(first), t) - x * (pace.change / square)) / square;
    }
    return out;
}

/// Parts one behind the other, each as long as it is even, whatever the curve turns by. Around a
/// cusp, where they would be shorter than `shortest`, the curve is led into the cusp and out of it
/// as along its chords: a stop, where there may be one.
class Walk {
  public:
    struct Wish {
        double most_uneven = 0;
        double shortest = 0;  ///< as a part of the curve's parameter
        bool may_stop = false;
    };

    Walk(const PathCurve& curve, const Wish& parts_are,
         std::span<PathCurve, most_spline_parts> parts)
        : whole(curve), wish(parts_are), out(parts) {}

    /// How many there are; 0 where there would be too many.
    std::size_t all();

  private:
    const PathCurve& whole;
    Wish wish;
    std::span<PathCurve, most_spline_parts> out;
    std::size_t count = 0;
    double at = 0;

    bool is_even(double width);
    double longest();
    double slowest() const;
    bool add(const PathPoint& from, const PathPoint& to);
    bool pass_cusp();
};

bool Walk::is_even(double width) {
    out[count] = part(whole, at, width);
    return out[count].length > 0 && unevenness(out[count]) <= wish.most_uneven;
}

/// How wide the part from here on may be; 0 where that is less than the shortest.
double Walk::longest() {
    constexpr int steps = 4;
    double most = 1 - at, width = most;
    if (is_even(width)) return width;
    while (!is_even(width)) {
        most = width;
        width *= 0.5;
        if (width < wish.shortest) return 0;
    }
    for (int step = 0; step < steps; ++step) {
        const double middle = 0.5 * (width + most);
        (is_even(middle) ? width : most) = middle;
    }
    is_even(width);
    return width;
}

/// Where the parameter's pace is least next, some of the shortest parts ahead.
double Walk::slowest() const {
    constexpr double reach = 4;
    constexpr int steps = 40;
    double a = at, b = std::min(1.0, at + reach * wish.shortest);
    for (int step = 0; step < steps; ++step) {
        const double c = a + (b - a) / 3, d = b - (b - a) / 3;
        (pace_at(whole, c).speed > pace_at(whole, d).speed ? a : b) =
            pace_at(whole, c).speed > pace_at(whole, d).speed ? c : d;
    }
    return 0.5 * (a + b);
}

/// One curve from a point to another, in its parts.
bool Walk::add(const PathPoint& from, const PathPoint& to) {
    std::array<PathCurve, most_spline_parts> parts;
    const std::size_t more = divide(whole_between(from, to), as_even_as_can_be, parts);
    if (more == 0 || count + more > out.size()) return false;
    std::copy(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(more),
              out.begin() + static_cast<std::ptrdiff_t>(count));
    count += more;
    return true;
}

bool Walk::pass_cusp() {
    double cusp = slowest();
    if (cusp - at < 0.25 * wish.shortest) cusp = at;
    if (1 - cusp < 0.25 * wish.shortest) cusp = 1;
    const PathVector tip = point_at(whole, cusp).position;
    if (cusp > at) {
        const PathPoint from = point_at(whole, at);
        if (!add(from, waypoint(from.position, tip, tip))) return false;
    }
    at = 1 - cusp < 3 * wish.shortest ? 1 : cusp + 2 * wish.shortest;
    if (cusp == 1) return true;
    const PathPoint to = point_at(whole, at);
    return add(waypoint(tip, tip, to.position), to);
}

std::size_t Walk::all() {
    while (at < 1) {
        if (count == out.size()) return 0;
        if (const double width = longest(); width > 0) {
            at = width == 1 - at ? 1 : at + width;
            ++count;
        } else if (!wish.may_stop || !pass_cusp()) {
            return 0;
        }
    }
    return count;
}

/// Into parts as even as 1e-4, or where these do not suffice as they can be: each as long as it may
/// be before they are less even than that.
std::size_t divided(const PathCurve& whole, std::span<PathCurve, most_spline_parts> out) {
    constexpr double even = 4e-4;
    constexpr Walk::Wish without_stop{even, 1e-6, false};
    for (const double most_uneven : {1e-4, even})
        if (const std::size_t count = divide(whole, most_uneven, out); count > 0) return count;
    if (const std::size_t count = Walk(whole, without_stop, out).all(); count > 0) return count;
    for (const double most_uneven : {2e-3, as_even_as_can_be})
        if (const std::size_t count = divide(whole, most_uneven, out); count > 0) return count;
    for (const double shortest : {1e-4, 1e-3, 1e-2})
        if (const std::size_t count = Walk(whole, {as_even_as_can_be, shortest, true}, out).all();
            count > 0)
            return count;
    return 0;
}

}  // namespace

std::size_t spline_between(const PathPoint& from, const PathPoint& to,
                           std::span<PathCurve, most_spline_parts> out) {
    const double chord = distance(from.position, to.position);
    if (!(chord > 0) || !std::isfinite(chord)) return 0;
    return divided(whole_between(from, to), out);
}

std::size_t quintic_between(const PathPoint& from, const PathPoint& to,
                            std::span<PathCurve, most_spline_parts> out) {
    return divided(quintic(from, to), out);
}

bool turns_back(const PathVector& a, const PathVector& b) {
    constexpr double least_turn = 1e-6;
    double aa = 0, ab = 0, off = 0, bb = 0;
    for (std::size_t i = 0; i < path_space; ++i) {
        aa += a[i] * a[i];
        ab += a[i] * b[i];
        bb += b[i] * b[i];
    }
    for (std::size_t i = 0; i < path_space; ++i) {
        const double upright = aa * b[i] - ab * a[i];
        off += upright * upright;
    }
    return ab < 0 && off <= least_turn * least_turn * aa * aa * bb;
}

PathPoint waypoint(const PathVector& before, const PathVector& at, const PathVector& after) {
    const double h0 = distance(before, at), h1 = distance(at, after);
    PathPoint out;
    out.position = at;
    const auto parabola = [&](std::size_t i, double l0, double l1) {
        const double d0 = (at[i] - before[i]) / l0, d1 = (after[i] - at[i]) / l1;
        out.tangent[i] = l0 == 0 ? d1 : l1 == 0 ? d0 : (d0 * l1 + d1 * l0) / (l0 + l1);
        out.bend[i] = l0 == 0 || l1 == 0 ? 0 : 2 * (d1 - d0) / (l0 + l1);
    };
    for (std::size_t i = 0; i < path_space; ++i) parabola(i, h0, h1);
    double square = 0, product = 0, bend = 0;
    for (std::size_t i = 0; i < path_space; ++i) {
        square += out.tangent[i] * out.tangent[i];
        product += out.tangent[i] * out.bend[i];
    }
    for (std::size_t i = 0; i < path_space; ++i) {
        out.bend[i] -= out.tangent[i] * product / square;
        out.tangent[i] /= std::sqrt(square);
        bend += out.bend[i] * out.bend[i];
    }
    const auto length_on_circle = [&](double chord) {
        const double sine = std::min(0.5 * chord * std::sqrt(bend), 1.0);
        return sine > 0 ? chord * Sleef_cinz_asind1_u10purec(sine) / sine : chord;
    };
    for (std::size_t i = path_space; i < most_path_axes; ++i)
        parabola(i, length_on_circle(h0), length_on_circle(h1));
    return out;
}

double distance_within(double deviation, const PathCurve& before, const PathCurve& after,
                       double most) {
    if (!(deviation > 0) || !(most > 0)) return 0;
    if (deviation == std::numeric_limits<double>::infinity()) return most;
    if (before.kind == PathCurveKind::line && after.kind == PathCurveKind::line) {
        const double bend = bend_between(before, after);
        return bend > 0 ? std::min(most, 16 * deviation / (3 * bend)) : 0;
    }
    double least = 0;
    if (deviation_of(before, after, most) <= deviation) return most;
    for (int step = 0; step < 24; ++step) {
        const double middle = 0.5 * (least + most);
        (deviation_of(before, after, middle) <= deviation ? least : most) = middle;
    }
    return least;
}

}  // namespace lineshaft

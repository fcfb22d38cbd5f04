#include "blocks/path/path_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sleef.h>

#include "blocks/path/path_bound.hpp"
#include "blocks/path/path_integral.hpp"

namespace lineshaft {

PathVector in_space(PathVector a) {
    for (std::size_t i = path_space; i < most_path_axes; ++i) a[i] = 0;
    return a;
}

namespace {

PathVector combined(const PathVector& a, double fa, const PathVector& b, double fb) {
    PathVector sum{};
    for (std::size_t i = 0; i < most_path_axes; ++i) sum[i] = fa * a[i] + fb * b[i];
    return sum;
}

double product(const PathVector& a, const PathVector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < most_path_axes; ++i) sum += a[i] * b[i];
    return sum;
}

/// Scaled by the greatest part, so that no square overflows.
double size_of(const PathVector& a) {
    double greatest = 0;
    for (const double x : a) greatest = std::max(greatest, std::abs(x));
    if (greatest == 0 || !std::isfinite(greatest)) return greatest;
    double sum = 0;
    for (const double x : a) sum += (x / greatest) * (x / greatest);
    return greatest * std::sqrt(sum);
}

bool finite(const PathVector& a) {
    for (const double x : a) {
        if (!std::isfinite(x)) return false;
    }
    return true;
}

PathVector difference(const PathVector& a, const PathVector& b) {
    return combined(a, 1, b, -1);
}

PathVector cross(const PathVector& a, const PathVector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

PathVector unit(const PathVector& a) {
    const double size = size_of(a);
    PathVector out = a;
    for (double& x : out) x /= size;
    return out;
}

/// What of `a` stands upright on the direction u; twice, as the first leaves a rounding of `a`.
PathVector upright(const PathVector& a, const PathVector& u) {
    const PathVector once = combined(a, 1, u, -product(a, u));
    return combined(once, 1, u, -product(once, u));
}

double angle_of(const PathVector& a, const PathVector& u, const PathVector& w) {
    const double angle = Sleef_cinz_atan2d1_u10purec(product(a, w), product(a, u));
    return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

/// How fast a corner is run along in the first three axes, and how far it has come, by t from 0 to
/// 1: x' = u + h (w - u) with h = 3 t^2 - 2 t^3.
class CornerWay {
  public:
    explicit CornerWay(const PathCurve& corner)
        : u_(in_space(corner.u)), turn_(combined(in_space(corner.w), 1, u_, -1)) {}

    double pace(double t) const { return size_of(combined(u_, 1, turn_, t * t * (3 - 2 * t))); }

    /// First and second derivative of the pace by t, where it is not 0.
    std::pair<double, double> change(double t) const {
        const double h = t * t * (3 - 2 * t), dh = 6 * t * (1 - t), ddh = 6 - 12 * t;
        const double across = product(u_, turn_), square = product(turn_, turn_), g = pace(t);
        const double first = dh * (across + h * square) / g;
        const double second = (ddh * (across + h * square) + dh * dh * square - first * first) / g;
        return {first, second};
    }

    /// Over 0..t. Where the pace is the same at both ends the second half is as long as the first.
    double until(double t) const {
        constexpr double rounding = 1e-14;
        const double start = product(u_, u_), across = product(u_, turn_);
        const double square = product(turn_, turn_);
        const auto pace_at = [&](double at) {
            const double h = at * at * (3 - 2 * at), pace = start + h * (2 * across + h * square);
            return pace > 0 ? std::sqrt(pace) : 0;
        };
        if (t == 1 && std::abs(2 * across + square) <= rounding * start)
            return 2 * integral_until<4>(0.5, pace_at);
        return integral_until(t, pace_at);
    }

  private:
    PathVector u_, turn_;
};

PathFault finish_arc(PathCurve& arc, double angle, PathCurve& out) {
    arc.kind = PathCurveKind::arc;
    arc.length = arc.radius * angle;
    if (!(arc.length > 0)) return PathFault::no_length;
    if (!std::isfinite(arc.length) || !finite(arc.origin)) return PathFault::not_finite;
    out = arc;
    return PathFault::none;
}

/// Below this sine of an angle three points lie on one line: the centre is not known to 1e-9.
constexpr double least_sine = 1e-6;

/// How far what is given of an arc may be from one.
double rounding_of(double radius, double rounding) {
    constexpr double relative = 1e-3, most = 0.1;
    return std::fmax(relative * radius, std::fmin(rounding, most * radius));
}

/// A place on a line or an arc, also where that is before its end.
PathVector place_on(PathCurve curve, double s) {
    curve.length = 2 * s;
    return curve.at(s).position;
}

double within_length(const PathCurve& curve, double s) {
    return s > 0 ? std::min(s, curve.length) : 0;
}

/// Between the places where its derivative changes its sign, of 64.
PathCurve::Extent extent_of_spline(const PathCurve& c, std::size_t axis) {
    constexpr int places = 64;
    PathCurve::Extent out{std::fmin(c.origin[axis], c.end[axis]),
                          std::fmax(c.origin[axis], c.end[axis])};
    for (int k = 0; k < places; ++k) {
        double a = c.length * k / places, b = c.length * (k + 1) / places;
        const bool rises = c.at(a).tangent[axis] > 0;
        if (rises == (c.at(b).tangent[axis] > 0)) continue;
        for (int step = 0; step < 40; ++step) {
            const double middle = 0.5 * (a + b);
            ((c.at(middle).tangent[axis] > 0) == rises ? a : b) = middle;
        }
        const double x = c.at(a).position[axis];
        out = {std::fmin(out.least, x), std::fmax(out.greatest, x)};
    }
    return out;
}

PathPoint point_of_spline(const PathCurve& c, double s) {
    const double per = 1 / c.length, t = s * per;
    const auto& m = c.map;
    const double at = t * (m[1] + t * (m[2] + t * (m[3] + t * (m[4] + t * m[5])))) + m[0];
    const double m1 =
        per * (m[1] + t * (2 * m[2] + t * (3 * m[3] + t * (4 * m[4] + t * 5 * m[5]))));
    const double m2 = per * per * (2 * m[2] + t * (6 * m[3] + t * (12 * m[4] + t * 20 * m[5])));
    const double m3 = per * per * per * (6 * m[3] + t * (24 * m[4] + t * 60 * m[5]));
    PathPoint out;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const double a = c.u[i], b = c.w[i], d = c.slope[i], e = c.fourth[i], f = c.fifth[i];
        const double x1 = a + at * (2 * b + at * (3 * d + at * (4 * e + at * 5 * f)));
        const double x2 = 2 * b + at * (6 * d + at * (12 * e + at * 20 * f));
        const double x3 = 6 * d + at * (24 * e + at * 60 * f);
        out.position[i] = c.origin[i] + at * (a + at * (b + at * (d + at * (e + at * f))));
        out.tangent[i] = x1 * m1;
        out.bend[i] = x2 * m1 * m1 + x1 * m2;
        out.twist[i] = x3 * m1 * m1 * m1 + 3 * x2 * m1 * m2 + x1 * m3;
    }
    return out;
}

}  // namespace

PathPoint PathCurve::at(double s) const {
    PathPoint out;
    s = within_length(*this, s);
    if (kind == PathCurveKind::spline) {
        out = point_of_spline(*this, s);
    } else if (kind == PathCurveKind::line) {
        out.position = combined(origin, 1, u, s);
        out.tangent = u;
    } else if (kind == PathCurveKind::corner) {
        const double t = s / length;
        const PathVector turn = difference(w, u);
        out.position =
            combined(combined(origin, 1, u, s), 1, turn, length * (t * t * t * (1 - 0.5 * t)));
        out.tangent = combined(u, 1, turn, t * t * (3 - 2 * t));
        for (std::size_t i = 0; i < most_path_axes; ++i) {
            out.bend[i] = turn[i] * (6 * t * (1 - t) / length);
            out.twist[i] = turn[i] * ((6 - 12 * t) / (length * length));
        }
    } else {
        const double sine = Sleef_cinz_sind1_u10purec(s / radius);
        const double cosine = Sleef_cinz_cosd1_u10purec(s / radius);
        const PathVector outwards = combined(u, cosine, w, sine);
        out.position = combined(combined(origin, 1, outwards, radius), 1, slope, s);
        const PathVector along = combined(w, cosine, u, -sine);
        out.tangent = combined(along, 1, slope, 1);
        for (std::size_t i = 0; i < most_path_axes; ++i) {
            out.bend[i] = -outwards[i] / radius;
            out.twist[i] = -along[i] / (radius * radius);
        }
    }
    if (s >= length) out.position = end;
    return out;
}

bool PathCurve::moves(std::size_t axis) const {
    return u[axis] != 0 || w[axis] != 0 || slope[axis] != 0 || fourth[axis] != 0 ||
           fifth[axis] != 0;
}

bool PathCurve::is_in_space() const {
    for (std::size_t i = 0; i < path_space; ++i)
        if (moves(i)) return true;
    return false;
}

PathCurve::Way PathCurve::way_at(double s) const {
    s = within_length(*this, s);
    if (kind != PathCurveKind::corner) return is_in_space() ? Way{s, 1, 0, 0} : Way{};
    const CornerWay way(*this);
    const double t = s / length;
    Way out{length * way.until(t), way.pace(t), 0, 0};
    if (out.slope == 0) return out;
    const auto [first, second] = way.change(t);
    out.bend = first / length;
    out.twist = second / (length * length);
    return out;
}

double PathCurve::share(std::size_t axis) const {
    if (kind == PathCurveKind::spline) return bound_of(*this, axis).tangent;
    if (kind == PathCurveKind::line) return std::abs(u[axis]);
    if (kind == PathCurveKind::corner) return std::fmax(std::abs(u[axis]), std::abs(w[axis]));
    return slope[axis] != 0 ? std::abs(slope[axis]) : std::hypot(u[axis], w[axis]);
}

PathCurve::Extent PathCurve::extent(std::size_t axis) const {
    if (kind == PathCurveKind::spline) return extent_of_spline(*this, axis);
    const double first = at(0).position[axis];
    Extent out{std::fmin(first, end[axis]), std::fmax(first, end[axis])};
    const double reach = kind == PathCurveKind::arc ? radius * std::hypot(u[axis], w[axis]) : 0;
    if (reach == 0) return out;
    const double turn = 2 * std::numbers::pi;
    double top = Sleef_cinz_atan2d1_u10purec(w[axis], u[axis]);
    if (top < 0) top += turn;
    const double bottom = top < std::numbers::pi ? top + std::numbers::pi : top - std::numbers::pi;
    if (top <= length / radius) out.greatest = origin[axis] + reach;
    if (bottom <= length / radius) out.least = origin[axis] - reach;
    return out;
}

void PathCurve::cut_end(double by) {
    length -= by;
    end = place_on(*this, length);
}

void PathCurve::cut_start(double by) {
    length -= by;
    if (kind == PathCurveKind::line) {
        origin = combined(origin, 1, u, by);
        return;
    }
    const double sine = Sleef_cinz_sind1_u10purec(by / radius);
    const double cosine = Sleef_cinz_cosd1_u10purec(by / radius);
    const PathVector outwards = combined(u, cosine, w, sine);
    w = combined(w, cosine, u, -sine);
    u = outwards;
    origin = combined(origin, 1, slope, by);
}

PathFault line_to(const PathVector& from, const PathVector& to, PathCurve& out,
                  std::size_t counted) {
    if (!finite(from) || !finite(to)) return PathFault::not_finite;
    const PathVector way = difference(to, from);
    PathVector measured = way;
    for (std::size_t i = counted; i < most_path_axes; ++i) measured[i] = 0;
    PathCurve line;
    line.length = size_of(size_of(measured) > 0 ? measured : way);
    if (!std::isfinite(line.length)) return PathFault::not_finite;
    if (!(line.length > 0)) return PathFault::no_length;
    line.origin = from;
    line.u = way;
    for (double& x : line.u) x /= line.length;
    if (!finite(line.u)) return PathFault::not_finite;
    line.end = to;
    out = line;
    return PathFault::none;
}

PathFault arc_through(const PathVector& from, const PathVector& border, const PathVector& to,
                      PathCurve& out) {
    if (!finite(from) || !finite(border) || !finite(to)) return PathFault::not_finite;
    const PathVector chord = difference(to, from), way = difference(border, from);
    const double length = size_of(chord), part = size_of(way);
    if (!std::isfinite(length) || !std::isfinite(part)) return PathFault::not_finite;
    if (length == 0 && part == 0) return PathFault::no_length;
    if (length == 0 || part == 0) return PathFault::no_arc;
    const PathVector e = unit(chord);
    const PathVector off = upright(way, e);
    const double height = size_of(off);
    if (height < least_sine * part) return PathFault::no_arc;
    // The centre is at (length / 2, y) of the plane (e, n), equally far from start and border.
    const PathVector n = unit(off);
    const double along = product(way, e);
    const double y = (along * (along - length) + height * height) / (2 * height);
    const PathVector to_centre = combined(e, length / 2, n, y);
    PathCurve arc;
    arc.radius = size_of(to_centre);
    arc.origin = combined(from, 1, to_centre, 1);
    arc.u = unit(difference(from, arc.origin));
    const PathVector across = upright(way, arc.u);
    arc.w = unit(size_of(across) < least_sine * part ? upright(chord, arc.u) : across);
    arc.end = to;
    const double to_border = angle_of(difference(border, arc.origin), arc.u, arc.w);
    double angle = angle_of(difference(to, arc.origin), arc.u, arc.w);
    if (angle < to_border) {
        for (double& x : arc.w) x = -x;
        angle = 2 * std::numbers::pi - angle;
    }
    return finish_arc(arc, angle, out);
}

PathFault arc_about(const PathVector& from, const PathVector& centre, const PathVector& to,
                    const PathVector& normal, double rounding, PathCurve& out) {
    if (!finite(from) || !finite(centre) || !finite(to)) return PathFault::not_finite;
    const PathVector n = unit(in_space(normal));
    if (!finite(n)) return PathFault::no_arc;
    const PathVector begin = in_space(difference(from, centre));
    const PathVector last = in_space(difference(to, centre));
    const double size = size_of(begin);
    if (!std::isfinite(size) || !std::isfinite(size_of(last))) return PathFault::not_finite;
    const double off = std::fmax(std::abs(product(begin, n)), std::abs(product(last, n)));
    if (size == 0 || off > least_sine * size ||
        !(std::abs(size_of(last) - size) <= rounding_of(size, rounding)))
        return PathFault::no_arc;
    const PathVector chord = in_space(difference(to, from));
    const bool closed = size_of(chord) == 0;
    if (!closed && size_of(chord) < least_sine * size) return PathFault::no_arc;
    // Moved to where both ends are equally far: what is given is rounded, and would be a jump.
    const PathVector middle = combined(from, 0.5, to, 0.5);
    const PathVector given = in_space(difference(centre, middle));
    const PathVector to_centre = closed ? given : upright(given, unit(chord));
    constexpr double most_moved = 0.1;
    if (size_of(difference(given, to_centre)) > most_moved * size) return PathFault::no_arc;
    PathCurve arc;
    arc.origin = in_space(combined(middle, 1, to_centre, 1));
    arc.radius = size_of(in_space(difference(from, arc.origin)));
    arc.u = unit(in_space(difference(from, arc.origin)));
    arc.w = unit(upright(cross(n, arc.u), arc.u));
    // At a half of a circle the plane is that of the normal, else that of the ends.
    const PathVector across = upright(in_space(difference(to, arc.origin)), arc.u);
    if (size_of(across) >= least_sine * arc.radius)
        arc.w = combined(unit(across), product(across, arc.w) < 0 ? -1 : 1, {}, 0);
    arc.end = to;
    const double angle = angle_of(in_space(difference(to, arc.origin)), arc.u, arc.w);
    return finish_arc(arc, closed ? 2 * std::numbers::pi : angle, out);
}

PathFault arc_of_radius(const PathVector& from, const PathVector& to, const PathVector& normal,
                        double rounding, PathCurve& out) {
    if (!finite(from) || !finite(to) || !finite(normal)) return PathFault::not_finite;
    const PathVector chord = in_space(difference(to, from));
    const double length = size_of(chord), radius = size_of(in_space(normal));
    if (!(length > 0)) return radius == 0 ? PathFault::no_length : PathFault::no_arc;
    const PathVector e = unit(chord), given = unit(in_space(normal));
    const double most = rounding_of(radius, rounding);
    if (!finite(given) || std::abs(product(given, e)) * radius > most) return PathFault::no_arc;
    const PathVector n = unit(upright(given, e));
    const double half = 0.5 * length;
    if (half > radius + most) return PathFault::no_arc;
    const double height = half < radius ? std::sqrt((radius - half) * (radius + half)) : 0;
    const PathVector middle = combined(from, 0.5, to, 0.5);
    return arc_about(from, combined(middle, 1, cross(n, e), height), to, n, rounding, out);
}

PathVector normal_upwards(const PathVector& from, const PathVector& centre, const PathVector& to) {
    const PathVector a = in_space(difference(from, centre)), b = in_space(difference(to, centre));
    const PathVector n = cross(a, b);
    const double flat = least_sine * size_of(a) * size_of(b);
    for (std::size_t i = path_space; i-- > 0;) {
        if (size_of(n) > flat && std::abs(n[i]) > flat)
            return combined(n, n[i] < 0 ? -1 : 1, {}, 0);
        if (size_of(n) <= flat && a[i] == 0 && b[i] == 0) {
            PathVector along{};
            along[i] = 1;
            return along;
        }
    }
    return {};
}

void let_follow(PathCurve& arc, const PathVector& from, const PathVector& to) {
    for (std::size_t i = path_space; i < most_path_axes; ++i) {
        arc.origin[i] = from[i];
        arc.slope[i] = (to[i] - from[i]) / arc.length;
        arc.u[i] = arc.w[i] = 0;
        arc.end[i] = to[i];
    }
}

PathCurve corner_between(const PathCurve& before, const PathCurve& after, double distance) {
    PathCurve corner;
    corner.kind = PathCurveKind::corner;
    corner.length = 2 * distance;
    corner.origin = combined(before.end, 1, before.u, -distance);
    corner.u = before.u;
    corner.w = after.u;
    corner.end = combined(after.origin, 1, after.u, distance);
    return corner;
}

double bend_between(const PathCurve& before, const PathCurve& after) {
    return size_of(in_space(difference(after.u, before.u)));
}

}  // namespace lineshaft

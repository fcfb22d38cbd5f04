#include "blocks/path/path_curve.hpp"

#include <cmath>
#include <numbers>

#include <sleef.h>

namespace lineshaft {

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
    for (const double x : a) greatest = std::fmax(greatest, std::abs(x));
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

}  // namespace

PathPoint PathCurve::at(double s) const {
    PathPoint out;
    s = std::fmin(std::fmax(s, 0), length);
    if (kind == PathCurveKind::line) {
        out.position = combined(origin, 1, u, s);
        out.tangent = u;
    } else {
        const double sine = Sleef_cinz_sind1_u10purec(s / radius);
        const double cosine = Sleef_cinz_cosd1_u10purec(s / radius);
        const PathVector outwards = combined(u, cosine, w, sine);
        out.position = combined(origin, 1, outwards, radius);
        out.tangent = combined(w, cosine, u, -sine);
        for (std::size_t i = 0; i < most_path_axes; ++i) {
            out.bend[i] = -outwards[i] / radius;
            out.twist[i] = -out.tangent[i] / (radius * radius);
        }
    }
    if (s >= length) out.position = end;
    return out;
}

double PathCurve::share(std::size_t axis) const {
    return kind == PathCurveKind::line ? std::abs(u[axis]) : std::hypot(u[axis], w[axis]);
}

PathFault line_to(const PathVector& from, const PathVector& to, PathCurve& out) {
    if (!finite(from) || !finite(to)) return PathFault::not_finite;
    const PathVector way = difference(to, from);
    PathCurve line;
    line.length = size_of(way);
    if (!std::isfinite(line.length)) return PathFault::not_finite;
    if (!(line.length > 0)) return PathFault::no_length;
    line.origin = from;
    line.u = unit(way);
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
    if (length == 0 || part == 0) return PathFault::no_length;
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
                    bool longer, PathCurve& out) {
    if (!finite(from) || !finite(centre) || !finite(to)) return PathFault::not_finite;
    const PathVector begin = difference(from, centre), last = difference(to, centre);
    PathCurve arc;
    arc.radius = size_of(begin);
    if (!std::isfinite(arc.radius) || !std::isfinite(size_of(last))) return PathFault::not_finite;
    if (arc.radius == 0) return PathFault::no_arc;
    if (std::abs(size_of(last) - arc.radius) > 1e-6 * arc.radius) return PathFault::no_arc;
    const PathVector chord = difference(to, from);
    if (size_of(chord) < least_sine * arc.radius) return PathFault::no_arc;
    // Moved to where both ends are equally far: what is given is rounded, and would be a jump.
    const PathVector middle = combined(from, 0.5, to, 0.5);
    arc.origin = combined(middle, 1, upright(difference(centre, middle), unit(chord)), 1);
    arc.radius = size_of(difference(from, arc.origin));
    arc.u = unit(difference(from, arc.origin));
    const PathVector across = upright(difference(to, arc.origin), arc.u);
    if (size_of(across) < least_sine * arc.radius) return PathFault::no_arc;
    arc.w = unit(across);
    arc.end = to;
    double angle = angle_of(difference(to, arc.origin), arc.u, arc.w);
    if (longer) {
        for (double& x : arc.w) x = -x;
        angle = 2 * std::numbers::pi - angle;
    }
    return finish_arc(arc, angle, out);
}

}  // namespace lineshaft

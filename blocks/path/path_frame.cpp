#include "blocks/path/path_frame.hpp"

#include <cmath>
#include <numbers>

#include <sleef.h>

namespace lineshaft {

namespace {

struct Turn {
    double cosine = 1, sine = 0;

    explicit Turn(double degrees) {
        const double quarters = std::nearbyint(degrees / 90);
        const double rest = (degrees - 90 * quarters) * (std::numbers::pi / 180);
        const double c = Sleef_cinz_cosd1_u10purec(rest), s = Sleef_cinz_sind1_u10purec(rest);
        const double whole = quarters - 4 * std::floor(quarters / 4);
        cosine = whole == 0 ? c : whole == 1 ? -s : whole == 2 ? -c : s;
        sine = whole == 0 ? s : whole == 1 ? c : whole == 2 ? -s : -c;
    }
};

PathFrame::Rows product(const PathFrame::Rows& a, const PathFrame::Rows& b) {
    PathFrame::Rows out{};
    for (std::size_t i = 0; i < path_space; ++i)
        for (std::size_t k = 0; k < path_space; ++k)
            for (std::size_t n = 0; n < path_space; ++n) out[i][k] += a[i][n] * b[n][k];
    return out;
}

}  // namespace

PathFrame PathFrame::of(const std::array<double, path_space>& shift,
                        const std::array<double, path_space>& about_x_y_z) {
    const Turn x(about_x_y_z[0]), y(about_x_y_z[1]), z(about_x_y_z[2]);
    const Rows about_z{{{z.cosine, -z.sine, 0}, {z.sine, z.cosine, 0}, {0, 0, 1}}};
    const Rows about_y{{{y.cosine, 0, y.sine}, {0, 1, 0}, {-y.sine, 0, y.cosine}}};
    const Rows about_x{{{1, 0, 0}, {0, x.cosine, -x.sine}, {0, x.sine, x.cosine}}};
    PathFrame out;
    out.shift = shift;
    out.turn = product(product(about_z, about_y), about_x);
    return out;
}

PathVector PathFrame::direction(const PathVector& vector) const {
    PathVector out = vector;
    for (std::size_t i = 0; i < path_space; ++i)
        out[i] = turn[i][0] * vector[0] + turn[i][1] * vector[1] + turn[i][2] * vector[2];
    return out;
}

PathVector PathFrame::place(const PathVector& point) const {
    PathVector out = direction(point);
    for (std::size_t i = 0; i < path_space; ++i) out[i] += shift[i];
    return out;
}

PathCurve PathFrame::curve(const PathCurve& curve) const {
    PathCurve out = curve;
    out.origin = place(curve.origin);
    out.end = place(curve.end);
    for (PathVector PathCurve::*part :
         {&PathCurve::u, &PathCurve::w, &PathCurve::slope, &PathCurve::fourth, &PathCurve::fifth})
        out.*part = direction(curve.*part);
    return out;
}

PathFrame PathFrame::inverse() const {
    PathFrame out;
    for (std::size_t i = 0; i < path_space; ++i) {
        for (std::size_t k = 0; k < path_space; ++k) out.turn[i][k] = turn[k][i];
        out.shift[i] = -(turn[0][i] * shift[0] + turn[1][i] * shift[1] + turn[2][i] * shift[2]);
    }
    return out;
}

}  // namespace lineshaft

#include "blocks/contour/path_rectangle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <sleef.h>

#include "blocks/circle/arc.hpp"
#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

/// A point of the path and the unit vector along it.
struct Place {
    Point at, along;
};

/// The lower right quarter, from the middle of the lower side: half a side, the corner, half the
/// next. `s` is the way from there, `a` and `b` half the straight parts.
Place quarter(double s, double a, double b, double r) {
    const double turn = std::numbers::pi / 2 * r;
    if (s < a) return {{s, -b - r}, {1, 0}};
    if (s >= a + turn) return {{a + r, -b + (s - a - turn)}, {0, 1}};
    const double phi = (s - a) / r;
    const double sine = Sleef_cinz_sind1_u10purec(phi), cosine = Sleef_cinz_cosd1_u10purec(phi);
    return {{a + r * sine, -b - r * cosine}, {cosine, sine}};
}

Point turned_left(Point p) {
    return {-p.y, p.x};
}

}  // namespace

std::span<const Field> PathRectangle::fields() {
    using P = PathRectangle;
    static const Field table[] = {
        parameter("width", &P::width, "mm", "from side to side").above(0),
        parameter("height", &P::height, "mm", "from side to side").above(0),
        parameter("corner_radius", &P::corner_radius, "mm", "of the round corners").above(0),
        parameter("centre_x", &P::centre_x, "mm", "centre"),
        parameter("centre_y", &P::centre_y, "mm", "centre"),
        input("length", &P::length, "mm", "travelled along the path").must_be_set(),
        input("velocity", &P::path_velocity, "mm/s", "along the path"),
        output("x", &P::x, "mm", "set-point"),
        output("y", &P::y, "mm", "set-point"),
        output("velocity_x", &P::velocity_x, "mm/s", "of x"),
        output("velocity_y", &P::velocity_y, "mm/s", "of y"),
        output("perimeter", &P::perimeter, "mm", "length of the whole path"),
        output("error", &P::error, "", "an input is not a number; outputs are held"),
        output("error_id", &P::error_id, "", "why").one_of(input_error_names),
    };
    return table;
}

void PathRectangle::scan(const Scan&) {
    error = !all_finite(length, path_velocity);
    error_id = error ? Error::not_finite : Error::none;
    if (error) return;
    const double r = corner_radius;
    double a = std::max(0.0, width / 2 - r), b = std::max(0.0, height / 2 - r);
    const double part = a + b + std::numbers::pi / 2 * r;
    perimeter = 4 * part;
    double s = std::fmod(length, perimeter);
    if (s < 0) s += perimeter;
    const int quarters = std::min(3, static_cast<int>(s / part));
    s -= quarters * part;
    if (quarters % 2 == 1) std::swap(a, b);
    Place place = quarter(s, a, b, r);
    for (int i = 0; i < quarters; ++i) place = {turned_left(place.at), turned_left(place.along)};
    x = centre_x + place.at.x;
    y = centre_y + place.at.y;
    velocity_x = path_velocity * place.along.x;
    velocity_y = path_velocity * place.along.y;
}

}  // namespace lineshaft

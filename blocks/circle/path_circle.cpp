#include "blocks/circle/path_circle.hpp"

#include "blocks/circle/arc.hpp"
#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view turn_names[] = {"clockwise", "counter_clockwise"};

}  // namespace

std::span<const Field> PathCircle::fields() {
    using P = PathCircle;
    static const Field table[] = {
        parameter("radius", &P::radius, "mm", "R").above(0).must_be_set(),
        parameter("centre_x", &P::centre_x, "mm", "centre"),
        parameter("centre_y", &P::centre_y, "mm", "centre"),
        parameter("start_angle", &P::start_angle, "rad",
                  "of length 0; 0 is above the centre, 90 deg on its right"),
        parameter("direction", &P::turn, "", "sense of rotation").one_of(turn_names),
        input("length", &P::length, "mm", "travelled along the circle").must_be_set(),
        input("velocity", &P::path_velocity, "mm/s", "along the circle"),
        input("acceleration", &P::path_acceleration, "mm/s^2", "along the circle"),
        output("x", &P::x, "mm", "set-point"),
        output("y", &P::y, "mm", "set-point"),
        output("velocity_x", &P::velocity_x, "mm/s", "of x"),
        output("velocity_y", &P::velocity_y, "mm/s", "of y"),
        output("acceleration_x", &P::acceleration_x, "mm/s^2", "of x"),
        output("acceleration_y", &P::acceleration_y, "mm/s^2", "of y"),
        output("error", &P::error, "", "an input cannot be followed; outputs are held"),
        output("error_id", &P::error_id, "", "why").one_of(input_error_names),
    };
    return table;
}

void PathCircle::scan(const Scan&) {
    const Arc arc{
        .radius = radius, .start = start_angle, .direction = turn == Turn::clockwise ? 1.0 : -1.0};
    const double theta = length / radius;
    const double omega = path_velocity / radius;
    const double alpha = path_acceleration / radius;
    const Point p = arc.at(theta), slope = arc.slope(theta);
    const Point v{slope.x * omega, slope.y * omega};
    const Point a{slope.x * alpha - p.x * omega * omega, slope.y * alpha - p.y * omega * omega};
    const bool good = all_finite(p.x, p.y, v.x, v.y, a.x, a.y, centre_x + p.x, centre_y + p.y);
    error_id = good ? Error::none : Error::not_finite;
    error = !good;
    if (error) return;
    x = centre_x + p.x;
    y = centre_y + p.y;
    velocity_x = v.x;
    velocity_y = v.y;
    acceleration_x = a.x;
    acceleration_y = a.y;
}

}  // namespace lineshaft

#include "blocks/contour/cross_coupling.hpp"

#include <algorithm>
#include <cmath>

#include "blocks/inputs.hpp"

namespace lineshaft {

std::span<const Field> CrossCoupling::fields() {
    using C = CrossCoupling;
    static const Field table[] = {
        parameter("gain", &C::gain, "", "correction per contour error").at_least(0),
        parameter("integral_time", &C::integral_time, "s", "of the integral; 0: none").at_least(0),
        parameter("limit", &C::limit, "mm", "greatest correction").at_least(0),
        input("enable", &C::enable, "", "false: the set-points are the commands"),
        input("command_x", &C::command_x, "mm", "set-point of the path").must_be_set(),
        input("command_y", &C::command_y, "mm", "set-point of the path").must_be_set(),
        input("contour_error", &C::contour_error, "mm", "above 0 on the left").must_be_set(),
        input("normal_x", &C::normal_x, "", "unit vector to the left of the path").must_be_set(),
        input("normal_y", &C::normal_y, "", "unit vector to the left of the path").must_be_set(),
        output("x", &C::x, "mm", "set-point for the drive"),
        output("y", &C::y, "mm", "set-point for the drive"),
        output("correction", &C::correction, "mm", "w, to the right of the path"),
        output("error", &C::error, "", "an input is not a number; no correction"),
        output("error_id", &C::error_id, "", "why").one_of(input_error_names),
    };
    return table;
}

void CrossCoupling::scan(const Scan& now) {
    const bool good = all_finite(command_x, command_y, contour_error, normal_x, normal_y);
    if (good && enable)
        control(seconds(now.interval));
    else
        correction = integral = 0;
    const double to_x = command_x - correction * (good ? normal_x : 0);
    const double to_y = command_y - correction * (good ? normal_y : 0);
    const bool set = all_finite(to_x, to_y);
    if (set) {
        x = to_x;
        y = to_y;
    }
    error = !good || !set;
    error_id = error ? Error::not_finite : Error::none;
}

void CrossCoupling::control(double interval) {
    const double proportional = gain * contour_error;
    const double next = integral_time > 0 ? integral + proportional * interval / integral_time : 0;
    const double wanted = proportional + next;
    correction = std::clamp(wanted, -limit, limit);
    if (wanted == correction) integral = next;
}

}  // namespace lineshaft

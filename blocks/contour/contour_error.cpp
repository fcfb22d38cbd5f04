#include "blocks/contour/contour_error.hpp"

#include <cmath>

#include "blocks/inputs.hpp"

namespace lineshaft {

std::span<const Field> ContourError::fields() {
    using C = ContourError;
    static const Field table[] = {
        input("command_x", &C::command_x, "mm", "set-point of the path").must_be_set(),
        input("command_y", &C::command_y, "mm", "set-point of the path").must_be_set(),
        input("actual_x", &C::actual_x, "mm", "actual position").must_be_set(),
        input("actual_y", &C::actual_y, "mm", "actual position").must_be_set(),
        output("contour_error", &C::contour_error, "mm", "above 0 on the left of the path"),
        output("absolute_error", &C::absolute_error, "mm", "of the contour"),
        output("following_error", &C::following_error, "mm", "command to actual point"),
        output("normal_x", &C::normal_x, "", "unit vector to the left of the path"),
        output("normal_y", &C::normal_y, "", "unit vector to the left of the path"),
        output("points_back", &C::points_back, "", "command points from the newest to the nearest"),
        output("at_newest", &C::at_newest, "", "the nearest command point is the newest"),
        output("out_of_reach", &C::out_of_reach, "",
               "the nearest point may have left the memory; the estimate is held"),
        output("error", &C::error, "", "an input is not a number; the estimate is held"),
        output("error_id", &C::error_id, "", "why").one_of(input_error_names),
    };
    return table;
}

void ContourError::scan(const Scan&) {
    const bool command = all_finite(command_x * command_x + command_y * command_y);
    if (command) path.add({command_x, command_y});
    error = !(command && all_finite(actual_x, actual_y) && measure());
    error_id = error ? Error::not_finite : Error::none;
}

/// False when the distances are beyond the range of numbers.
bool ContourError::measure() {
    const double dx = actual_x - command_x, dy = actual_y - command_y;
    const double following = std::sqrt(dx * dx + dy * dy);
    const ContourEstimate e = path.estimate({actual_x, actual_y});
    if (!all_finite(following, e.signed_error, e.normal.x, e.normal.y)) return false;
    following_error = following;
    out_of_reach = e.out_of_reach;
    points_back = e.points_back;
    if (out_of_reach) return true;
    at_newest = e.at_newest;
    contour_error = e.signed_error;
    absolute_error = std::abs(e.signed_error);
    normal_x = e.normal.x;
    normal_y = e.normal.y;
    return true;
}

}  // namespace lineshaft

#include <algorithm>
#include <cmath>

#include "blocks/axis/axis.hpp"

namespace lineshaft {

bool is_bool_parameter(std::int64_t number) {
    return number == 4 || number == 5;
}

/// The one that may be written by this number; null: there is none.
double* Axis::limit_of(std::int64_t number) {
    switch (number) {
        case 2:
            return &highest_position;
        case 3:
            return &lowest_position;
        case 9:
            return &default_velocity;
        case 13:
            return &default_acceleration;
        case 15:
            return &default_deceleration;
        case 17:
            return &default_jerk;
        default:
            return nullptr;
    }
}

bool Axis::sets_parameter(const Field& field) {
    Axis axis;
    const std::byte* const first = reinterpret_cast<const std::byte*>(&axis);
    const auto is_at = [&](const void* place) { return place == first + field.offset; };
    constexpr std::int64_t numbers[] = {2, 3, 9, 13, 15, 17};
    return is_at(&axis.software_limits) ||
           std::ranges::any_of(numbers, [&](std::int64_t n) { return is_at(axis.limit_of(n)); });
}

std::optional<double> Axis::read_parameter(std::int64_t number) const {
    if (number == 1) return position;
    if (is_bool_parameter(number)) return software_limits ? 1 : 0;
    if (number == 10) return actual().velocity;
    if (number == 11) return velocity;
    const double* limit = const_cast<Axis*>(this)->limit_of(number);
    if (!limit) return {};
    return *limit;
}

/// What an axis needs to be able to stop stays above 0, and limits that count stay in order.
MotionError Axis::write_parameter(const Context& context, std::int64_t number, double value) {
    if (is_bool_parameter(number)) {
        const bool wanted = value != 0;
        if (wanted && (modulo || !(lowest_position < highest_position)))
            return MotionError::out_of_range;
        software_limits = wanted;
        watch_limits();
        return MotionError::none;
    }
    double* limit = limit_of(number);
    if (!limit) return MotionError::no_such_parameter;
    const bool is_position = number == 2 || number == 3;
    const bool good = is_position || value > 0 || (number == 17 && value == 0);
    if (!good || !std::isfinite(value)) return MotionError::out_of_range;
    const double before = *limit;
    *limit = value;
    look_ahead(context);
    if (!software_limits || lowest_position < highest_position) return MotionError::none;
    *limit = before;
    return MotionError::out_of_range;
}

}  // namespace lineshaft

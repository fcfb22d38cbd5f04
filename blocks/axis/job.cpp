#include "blocks/axis/job.hpp"

#include <fmt/format.h>

namespace lineshaft {

std::string text_of(MotionError error, const Shortage& shortage, std::string_view unit) {
    if (error != MotionError::sync_limits || !(shortage.needed > shortage.allowed))
        return std::string(text_of(error));
    if (shortage.limit == CurveFault::none)
        return fmt::format(
            "the coupling takes {:.5g} times the velocity, acceleration and jerk that are "
            "the limit",
            shortage.needed);
    const auto quantity =
        static_cast<std::size_t>(shortage.limit) - static_cast<std::size_t>(CurveFault::velocity);
    constexpr std::string_view names[] = {"a velocity", "an acceleration", "a jerk"};
    constexpr std::string_view per[] = {"/s", "/s^2", "/s^3"};
    return fmt::format("the coupling takes {} of {:.5g} {}{}, and {:.5g} {}{} is the limit",
                       names[quantity], shortage.needed, unit, per[quantity], shortage.allowed,
                       unit, per[quantity]);
}

}  // namespace lineshaft

#include "blocks/motion/moves.hpp"

namespace lineshaft::command_kinds {

using namespace pin;

std::span<const Field> absolute_fields() {
    static const auto fields =
        table({continuous_update(), pin::position("target"), velocity(), acceleration(),
               deceleration(), jerk(), direction(), buffer_mode()},
              done("the target is reached"));
    return fields;
}

std::span<const Field> distance_fields() {
    static const auto fields = table({continuous_update(), distance(), velocity(), acceleration(),
                                      deceleration(), jerk(), buffer_mode()},
                                     done("the distance has been travelled"));
    return fields;
}

std::span<const Field> velocity_fields() {
    static const auto fields =
        table({continuous_update(), velocity("wanted, with its sign"), acceleration(),
               deceleration(), jerk(), direction(), buffer_mode()},
              reached("InVelocity", "the velocity is reached"));
    return fields;
}

std::span<const Field> continuous_absolute_fields() {
    static const auto fields =
        table({continuous_update(), pin::position("that is passed"), end_velocity(), velocity(),
               acceleration(), deceleration(), jerk(), direction(), buffer_mode()},
              reached("InEndVelocity", "the position has been passed"));
    return fields;
}

std::span<const Field> continuous_relative_fields() {
    static const auto fields = table({continuous_update(), distance(), end_velocity(), velocity(),
                                      acceleration(), deceleration(), jerk(), buffer_mode()},
                                     reached("InEndVelocity", "the distance has been travelled"));
    return fields;
}

std::span<const Field> halt_fields() {
    static const auto fields =
        table({deceleration(), jerk(), buffer_mode()}, done("the axis stands"));
    return fields;
}

std::span<const Field> halt_superimposed_fields() {
    static const auto fields =
        table({deceleration(), jerk()}, done("nothing is superimposed any more"));
    return fields;
}

}  // namespace lineshaft::command_kinds

namespace lineshaft {

std::span<const Field> MoveSuperimposed::fields() {
    static const auto fields = [] {
        auto table = pin::table({pin::continuous_update(), pin::distance(),
                                 input("VelocityDiff", &CommandBlock::pins, &Request::velocity,
                                       "{Axis}/s", "greatest in addition; below 0: the axis' own"),
                                 pin::acceleration(), pin::deceleration(), pin::jerk()},
                                pin::done("the distance has been added"));
        table.push_back(output("CoveredDistance", &MoveSuperimposed::covered_distance, "{Axis}",
                               "that it has added so far"));
        return table;
    }();
    return fields;
}

void MoveSuperimposed::scan(const Scan& now, const Context& context) {
    run(now, context);
    covered_distance = covered(context, &Axis::added);
}

}  // namespace lineshaft

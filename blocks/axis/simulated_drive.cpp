#include "blocks/axis/simulated_drive.hpp"

namespace lineshaft {

std::span<const Field> SimulatedDrive::fields() {
    using D = SimulatedDrive;
    static const Field table[] = {
        parameter("unit", &D::unit, "", "unit of the axis").one_of(axis_unit_names),
        input("set_position", &D::set_position, "{unit}", "set-point of the axis").must_be_set(),
        input("set_velocity", &D::set_velocity, "{unit}/s", "of the set-point"),
        output("position", &D::position, "{unit}", "actual position"),
        output("velocity", &D::velocity, "{unit}/s", "actual velocity"),
    };
    return table;
}

void SimulatedDrive::scan(const Scan&) {
    if (!all_finite(set_position, set_velocity)) return;
    position = set_position;
    velocity = set_velocity;
}

}  // namespace lineshaft

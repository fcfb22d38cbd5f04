#include "blocks/group/group_reads.hpp"

#include <array>
#include <vector>

namespace lineshaft {

namespace {

Field element(std::string_view name, std::string_view doc, Type type, std::size_t offset) {
    Field f;
    f.name = name;
    f.doc = doc;
    f.direction = Direction::output;
    f.type = type;
    f.offset = offset;
    return f;
}

/// AxesGroup, Enable and the outputs of all.
std::vector<Field> group_read_table() {
    using B = GroupReadBlock;
    return {in_out("AxesGroup", &B::group, AxesGroup::type, "that is looked at")
                .one_of(axis_unit_names),
            input("Enable", &B::enable, "", "the outputs follow the group"),
            output("Valid", &B::valid, "", "the outputs can be relied on"),
            output("Busy", &B::busy, "", "the block looks at the group"),
            output("Error", &B::error, "", "there is nothing to tell"),
            output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names)};
}

/// ... and a number for each axis, by the axes' places in the group.
std::vector<Field> group_vector_table(std::string_view unit, std::string_view rotary,
                                      const std::array<std::string_view, most_path_axes>& names) {
    auto fields = group_read_table();
    fields.push_back(input("CoordSystem", &GroupReadVector::coordinates, "",
                           "of the numbers: the machine's, or the product's")
                         .one_of(coord_system_names));
    const std::size_t first = detail::offset_of(&GroupReadVector::value);
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        Field f =
            element(names[i], "of the axis in that place", Type::real, first + i * sizeof(double));
        f.unit = i < path_space ? unit : rotary;
        fields.push_back(f);
    }
    return fields;
}

}  // namespace

const AxesGroup* GroupReadBlock::look(const Context& context) {
    error = enable && group == nowhere;
    error_id = error ? MotionError::no_group : MotionError::none;
    valid = busy = enable && !error;
    return valid ? &context.seen_instance<AxesGroup>(group) : nullptr;
}

std::span<const Field> GroupReadStatus::fields() {
    using B = GroupReadStatus;
    static const auto table = [] {
        constexpr std::string_view names[] = {"GroupDisabled", "GroupStandby",  "GroupMoving",
                                              "GroupHoming",   "GroupStopping", "GroupErrorStop"};
        auto fields = group_read_table();
        const std::size_t first = detail::offset_of(&B::states);
        for (std::size_t i = 0; i < group_state_count; ++i)
            fields.push_back(
                element(names[i], "the group is in that state", Type::boolean, first + i));
        fields.push_back(output("ConstantVelocity", &B::constant_velocity, "", "0 too"));
        fields.push_back(output("Accelerating", &B::accelerating, "", "along the path"));
        fields.push_back(output("Decelerating", &B::decelerating, "", "along the path"));
        fields.push_back(output("InPosition", &B::in_position, "", "no path is under way"));
        return fields;
    }();
    return table;
}

void GroupReadStatus::scan(const Scan&, const Context& context) {
    const AxesGroup* seen = look(context);
    for (std::size_t i = 0; i < group_state_count; ++i)
        states[i] = seen && static_cast<std::size_t>(seen->state) == i;
    const double a = seen ? seen->acceleration : 0;
    constant_velocity = seen && a == 0;
    accelerating = a > 0;
    decelerating = a < 0;
    in_position = seen && !seen->is_in_path();
}

std::span<const Field> GroupReadError::fields() {
    static const auto table = [] {
        auto fields = group_read_table();
        fields.push_back(output("GroupErrorID", &GroupReadError::group_error, "", "of the group")
                             .one_of(motion_error_names));
        return fields;
    }();
    return table;
}

void GroupReadError::scan(const Scan&, const Context& context) {
    const AxesGroup* seen = look(context);
    group_error = seen ? seen->error_id : MotionError::none;
}

std::span<const Field> GroupReadActualPosition::fields() {
    static const auto table = group_vector_table(
        "{AxesGroup}", "deg",
        {"Position1", "Position2", "Position3", "Position4", "Position5", "Position6"});
    return table;
}

void GroupReadActualPosition::scan(const Scan&, const Context& context) {
    if (const AxesGroup* seen = look(context))
        value = seen->frame_of(coordinates).inverse().place(seen->actual_position(context));
}

std::span<const Field> GroupReadSetPosition::fields() {
    return GroupReadActualPosition::fields();
}

void GroupReadSetPosition::scan(const Scan&, const Context& context) {
    if (const AxesGroup* seen = look(context))
        value = seen->frame_of(coordinates).inverse().place(seen->set_position(context));
}

std::span<const Field> GroupReadActualVelocity::fields() {
    static const auto table = group_vector_table(
        "{AxesGroup}/s", "deg/s",
        {"Velocity1", "Velocity2", "Velocity3", "Velocity4", "Velocity5", "Velocity6"});
    return table;
}

void GroupReadActualVelocity::scan(const Scan&, const Context& context) {
    if (const AxesGroup* seen = look(context))
        value = seen->frame_of(coordinates).inverse().direction(seen->actual_velocity(context));
}

}  // namespace lineshaft

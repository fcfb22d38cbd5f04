#include "blocks/group/group_moves.hpp"

#include "blocks/group/path_table.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view target =
    "target of the axis; of a modulo axis in the period that it shows";

std::vector<Field> positions(std::string_view name, std::string_view doc) {
    return group_pin::coordinates(name, &GroupRequest::target, most_path_axes, doc);
}

std::vector<Field> circle_pins(std::string_view to) {
    using B = GroupCommandBlock;
    std::vector<Field> fields{
        input("CircMode", &B::pins, &GroupRequest::circle, "", "what AuxPoint is")
            .one_of(circle_mode_names)};
    const auto auxiliary =
        group_pin::coordinates("AuxPoint", &GroupRequest::auxiliary, path_space,
                               "a point of the arc, its centre, or the tip of a vector from the "
                               "start, upright on its plane and as long as the radius");
    const auto end = positions("EndPoint", to);
    fields.insert(fields.end(), auxiliary.begin(), auxiliary.end());
    fields.insert(fields.end(), end.begin(), end.end());
    fields.push_back(input("PathChoice", &B::pins, &GroupRequest::choice, "",
                           "seen from where the vector points to, or the third axis; not of "
                           "mcBorder")
                         .one_of(path_choice_names));
    return fields;
}

}  // namespace

namespace group_kinds {

using namespace group_pin;

std::span<const Field> move_absolute_fields() {
    static const auto fields =
        table({positions("Position", target), dynamics(), coordinate_system(), blending()});
    return fields;
}

std::span<const Field> move_relative_fields() {
    static const auto fields = table(
        {positions("Distance", "way of the axis"), dynamics(), coordinate_system(), blending()});
    return fields;
}

std::span<const Field> circle_absolute_fields() {
    static const auto fields =
        table({circle_pins(target), dynamics(), coordinate_system(), blending()});
    return fields;
}

std::span<const Field> circle_relative_fields() {
    static const auto fields =
        table({circle_pins("way of the axis"), dynamics(), coordinate_system(), blending()});
    return fields;
}

std::span<const Field> direct_absolute_fields() {
    static const auto fields =
        table({positions("Position", target), coordinate_system(), blending()});
    return fields;
}

std::span<const Field> direct_relative_fields() {
    static const auto fields =
        table({positions("Distance", "way of the axis"), coordinate_system(), blending()});
    return fields;
}

}  // namespace group_kinds

std::span<const Field> MovePath::fields() {
    static const auto fields =
        group_pin::table({{in_out("PathData", &MovePath::path_data, PathTable::type, "the points")},
                          group_pin::dynamics(),
                          group_pin::coordinate_system(),
                          group_pin::blending()});
    return fields;
}

void MovePath::scan(const Scan& now, const Context& context) {
    pins.table = path_data;
    run(now, context);
}

}  // namespace lineshaft

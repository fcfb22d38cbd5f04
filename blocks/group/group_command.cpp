#include "blocks/group/group_command.hpp"

#include <algorithm>
#include <array>

#include "blocks/inputs.hpp"

namespace lineshaft {

void GroupCommandBlock::run(const Scan& now, const Context& context) {
    if (rising_edge(execute, last_execute)) start(now, context);
    show(job, context);
}

void GroupCommandBlock::start(const Scan& now, const Context& context) {
    if (!begin(job, check())) return;
    job.request = pins;
    context.instance<AxesGroup>(group).send(context, now, job);
}

std::string GroupCommandBlock::why(const Context&, const NameOf&) const {
    if (error_id != MotionError::wrong_state) return std::string(text_of(error_id));
    if (pins.command == GroupCommand::go_on)
        return "nothing is interrupted, or the group moves: MC_GroupContinue goes on where "
               "MC_GroupInterrupt has stopped it";
    return "the command does not go with what the group is doing; `lineshaft states` says what "
           "each "
           "of its states takes";
}

MotionError GroupCommandBlock::check() const {
    if (group == nowhere) return MotionError::no_group;
    for (const PathVector& vector : {pins.target, pins.auxiliary, pins.transform})
        for (const double part : vector)
            if (!all_finite(part)) return MotionError::not_finite;
    return all_finite(pins.corner_parameter, pins.velocity, pins.acceleration, pins.deceleration,
                      pins.jerk, pins.velocity_factor, pins.acceleration_factor, pins.jerk_factor)
               ? MotionError::none
               : MotionError::not_finite;
}

namespace group_pin {

using B = GroupCommandBlock;

Field group() {
    return in_out("AxesGroup", &B::group, AxesGroup::type, "that is commanded")
        .one_of(axis_unit_names);
}

std::vector<Field> coordinates(std::string_view name, PathVector GroupRequest::*member,
                               std::size_t count, std::string_view doc) {
    static constexpr std::string_view names[][most_path_axes] = {
        {"Position1", "Position2", "Position3", "Position4", "Position5", "Position6"},
        {"Distance1", "Distance2", "Distance3", "Distance4", "Distance5", "Distance6"},
        {"AuxPoint1", "AuxPoint2", "AuxPoint3", "AuxPoint4", "AuxPoint5", "AuxPoint6"},
        {"TransX", "TransY", "TransZ", "RotAngle1", "RotAngle2", "RotAngle3"},
        {"EndPoint1", "EndPoint2", "EndPoint3", "EndPoint4", "EndPoint5", "EndPoint6"}};
    const auto& row =
        *std::ranges::find_if(names, [&](const auto& n) { return n[0].starts_with(name); });
    std::vector<Field> fields;
    for (std::size_t i = 0; i < count; ++i) {
        Field f;
        f.name = row[i];
        f.doc = doc;
        f.unit = i < path_space ? "{AxesGroup}" : "deg";
        f.direction = Direction::input;
        f.offset = detail::offset_of(&B::pins) + detail::offset_of(member) + i * sizeof(double);
        fields.push_back(f);
    }
    return fields;
}

std::vector<Field> dynamics() {
    return {
        input(
            "Velocity", &B::pins, &GroupRequest::velocity, "{AxesGroup}/s",
            "of the first three axes along the path, greatest; rotary axes follow, and where they "
            "move alone only their own limits count; below 0: the group's own"),
        input("Acceleration", &B::pins, &GroupRequest::acceleration, "{AxesGroup}/s^2",
              "limit, as Velocity; below 0: the group's own"),
        input("Deceleration", &B::pins, &GroupRequest::deceleration, "{AxesGroup}/s^2",
              "limit; the lesser of both counts both ways; below 0: as Acceleration"),
        input("Jerk", &B::pins, &GroupRequest::jerk, "{AxesGroup}/s^3",
              "limit, as Velocity; below 0: the group's own")};
}

std::vector<Field> braking() {
    return {input("Deceleration", &B::pins, &GroupRequest::deceleration, "{AxesGroup}/s^2",
                  "along the path; below 0: as hard as the moves allow"),
            input("Jerk", &B::pins, &GroupRequest::jerk, "{AxesGroup}/s^3",
                  "along the path; below 0: as the moves allow")};
}

std::vector<Field> coordinate_system() {
    return {input("CoordSystem", &B::pins, &GroupRequest::coordinates, "",
                  "positions are the machine's, or the product's (MC_SetCartesianTransform)")
                .one_of(coord_system_names)};
}

std::vector<Field> blending() {
    return {input("BufferMode", &B::pins, &GroupRequest::mode, "",
                  "what becomes of the command at work")
                .one_of(buffer_mode_names),
            input("TransitionMode", &B::pins, &GroupRequest::corner, "",
                  "how the joint of two lines or arcs is rounded where moves are blended; of "
                  "mcTMStartVelocity two lines")
                .one_of(corner_mode_names),
            input("TransitionParameter", &B::pins, &GroupRequest::corner_parameter, "{AxesGroup}",
                  "distance from the joint, or greatest deviation; of mcTMStartVelocity the "
                  "velocity there, as a number of the same unit a second")
                .at_least(0)};
}

std::vector<Field> table(std::initializer_list<std::vector<Field>> inputs, std::string_view done) {
    std::vector<Field> fields{group(),
                              input("Execute", &B::execute, "", "rising edge: the command begins")};
    for (const std::vector<Field>& more : inputs)
        fields.insert(fields.end(), more.begin(), more.end());
    fields.insert(
        fields.end(),
        {output("Done", &B::done, "", done),
         output("Busy", &B::busy, "", "the command has not ended yet"),
         output("Active", &B::active, "", "it controls the group"),
         output("CommandAborted", &B::command_aborted, "", "another command has taken over"),
         output("Error", &B::error, "", "the command is refused, or the group has failed"),
         output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names)});
    return fields;
}

}  // namespace group_pin

}  // namespace lineshaft

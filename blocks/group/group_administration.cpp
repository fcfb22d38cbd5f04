#include "blocks/group/group_administration.hpp"

namespace lineshaft {

namespace {

Field ident_in_group() {
    return input("IdentInGroup", &GroupCommandBlock::pins, &GroupRequest::place, "",
                 "place of the axis: 1 to 3 in the group's unit, 4 to 6 rotary")
        .at_least(1)
        .at_most(static_cast<double>(most_path_axes));
}

}  // namespace

std::span<const Field> AddAxisToGroup::fields() {
    static const auto fields = group_pin::table(
        {{in_out("Axis", &AddAxisToGroup::axis, Axis::type, "that joins").one_of(axis_unit_names),
          ident_in_group()}});
    return fields;
}

void AddAxisToGroup::scan(const Scan& now, const Context& context) {
    pins.axis = axis;
    run(now, context);
}

std::span<const Field> GroupStop::fields() {
    static const auto fields = group_pin::table({group_pin::braking()}, "the group stands");
    return fields;
}

void GroupStop::scan(const Scan& now, const Context& context) {
    pins.holds = execute ? 1 : 0;
    const bool released = last_execute && !execute && refusal == MotionError::none;
    run(now, context);
    if (!released) return;
    job.request = pins;
    context.instance<AxesGroup>(group).send(context, now, job);
}

std::span<const Field> GroupInterrupt::fields() {
    static const auto fields = [] {
        auto inputs = group_pin::braking();
        inputs.push_back(input("FreesGroup", &GroupInterrupt::frees_group, "",
                               "once it stands the group takes other moves, and MC_GroupContinue "
                               "goes on after one to where it stood"));
        return group_pin::table({inputs}, "the group stands");
    }();
    return fields;
}

void GroupInterrupt::scan(const Scan& now, const Context& context) {
    pins.frees = frees_group ? 1 : 0;
    run(now, context);
}

std::span<const Field> GroupSetOverride::fields() {
    using B = GroupSetOverride;
    static const Field table[] = {
        group_pin::group(),
        input("Enable", &B::execute, "", "true: the factors count, and go on to when it falls"),
        input("VelFactor", &B::pins, &GroupRequest::velocity_factor, "",
              "of the velocity along the path; above 1 as 1; 0: standstill")
            .at_least(0),
        input("AccFactor", &B::pins, &GroupRequest::acceleration_factor, "", "1 only"),
        input("JerkFactor", &B::pins, &GroupRequest::jerk_factor, "", "1 only"),
        output("Enabled", &B::done, "", "the factor is that of the group"),
        output("Busy", &B::busy, "", "the group has not taken it yet"),
        output("Error", &B::error, "", "the factors are refused"),
        output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names),
    };
    return table;
}

void GroupSetOverride::scan(const Scan& now, const Context& context) {
    const bool changed = started && refusal == MotionError::none && pins != job.request;
    const bool again = execute && last_execute && changed;
    const bool rises = rising_edge(execute, last_execute);
    if (again || rises) start(now, context);
    show(job, context);
    done = done && execute;
}

std::span<const Field> GroupPower::fields() {
    using B = GroupPower;
    static const Field table[] = {
        group_pin::group(),
        input("Enable", &B::execute, "", "the power is on"),
        output("Status", &B::status, "", "the power of all axes is on, as they have it"),
        output("Valid", &B::active, "", "Status can be relied on"),
        output("Error", &B::error, "", "there is no group"),
        output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names),
    };
    return table;
}

void GroupPower::scan(const Scan& now, const Context& context) {
    const bool changed = !started || execute != last_execute;
    pins.is_enabled = execute ? 1 : 0;
    last_execute = execute;
    if (changed) start(now, context);
    error = refusal != MotionError::none;
    error_id = refusal;
    active = !error;
    status = !error && context.seen_instance<AxesGroup>(group).is_powered(context);
}

namespace group_kinds {

std::span<const Field> remove_axis_fields() {
    static const auto fields = group_pin::table({{ident_in_group()}});
    return fields;
}

std::span<const Field> plain_fields() {
    static const auto fields = group_pin::table({});
    return fields;
}

std::span<const Field> standing_fields() {
    static const auto fields = group_pin::table({group_pin::braking()}, "the group stands");
    return fields;
}

std::span<const Field> transform_fields() {
    static const auto fields = [] {
        auto shift = group_pin::coordinates("Trans", &GroupRequest::transform, most_path_axes,
                                            "of the product's origin");
        constexpr std::string_view about[] = {"about the product's x, after the others",
                                              "about its y, after z", "about its z, first"};
        for (std::size_t i = 0; i < path_space; ++i) shift[path_space + i].doc = about[i];
        return group_pin::table({shift}, "moves that are taken up from now on count from there");
    }();
    return fields;
}

}  // namespace group_kinds

}  // namespace lineshaft

#include "blocks/motion/moves.hpp"

#include "blocks/inputs.hpp"

namespace lineshaft::command_kinds {

using namespace pin;

/// With Ends, as the jogs of vendors have it.
static std::vector<Field> with_end(std::vector<Field> fields) {
    fields.push_back(ends());
    return fields;
}

std::span<const Field> absolute_fields() {
    static const auto fields = with_end(table(
        {continuous_update(), pin::position("target"), velocity(), acceleration(), deceleration(),
         jerk(), direction(), buffer_mode(),
         input("Period", &CommandBlock::pins, &Request::period, "{Axis}",
               "whose whole turns in Position count, of any axis, as TwinCAT's; below 0: Position "
               "counts over all turns; 0: of a modulo axis Position is a place in its period")},
        done("the target is reached")));
    return fields;
}

std::span<const Field> distance_fields() {
    static const auto fields =
        with_end(table({continuous_update(), distance(), velocity(), acceleration(), deceleration(),
                        jerk(), buffer_mode()},
                       done("the distance has been travelled")));
    return fields;
}

std::span<const Field> velocity_fields() {
    static const auto fields = [] {
        auto made = with_end(table(
            {continuous_update(), velocity("wanted, with its sign"), acceleration(), deceleration(),
             jerk(),
             direction("negative: the other way than Velocity says; current: as the axis moves"),
             buffer_mode()},
            reached("InVelocity", "the velocity is reached")));
        made.push_back(
            local("Jogs", &CommandBlock::pins, &Request::jogs, "", "1: it is that of MC_MoveJog"));
        made.push_back(local("Ended", &CommandBlock::done, "", "by Ends: the axis stands"));
        return made;
    }();
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
        table.push_back(local("VelocityProcess", &CommandBlock::pins, &Request::process_velocity,
                              "{Axis}/s",
                              "above 0: it goes by the way of the motion beneath, as at this "
                              "velocity of that over time"));
        table.push_back(local("AbortedBy", &CommandBlock::pins, &Request::aborted_by, "",
                              "of one that does, where the motion beneath stands, is at its end "
                              "or stopped, or neither")
                            .one_of(aborted_by_names));
        return table;
    }();
    return fields;
}

void MoveSuperimposed::scan(const Scan& now, const Context& context) {
    run(now, context);
    covered_distance = covered(context, &Axis::added);
}

std::span<const Field> MotionInPosition::fields() {
    using B = CommandBlock;
    static const Field table[] = {
        pin::axis(),
        input("Enable", &B::execute, "", "the axis takes the set-points; falling: it brakes"),
        pin::position("set-point; of a modulo axis the next place that shows it"),
        input("Velocity", &B::pins, &Request::velocity, "{Axis}/s", "of the set-point"),
        input("Acceleration", &B::pins, &Request::acceleration, "{Axis}/s^2", "of the set-point"),
        output("Busy", &B::busy, "", "the command has not ended yet"),
        output("Active", &B::active, "", "it controls the axis"),
        output("CommandAborted", &B::command_aborted, "", "another command has taken over"),
        output("Error", &B::error, "", "the command is refused, or the axis has failed"),
        output("ErrorID", &B::error_id, "", "why").one_of(motion_error_names)};
    return table;
}

void MotionInPosition::scan(const Scan& now, const Context& context) {
    pins.is_enabled = execute ? 1 : 0;
    const bool goes_on = execute || job.request.is_enabled != 0;
    const bool is_free = job.in == JobPlace::no_list ||
                         (job.task == context.task && job.scan == now.index);  // a second call
    if (rising_edge(execute, last_execute))
        start(now, context);
    else if (goes_on && is_free && is_at_work(context))
        update(now, context);
    show(context);
}

}  // namespace lineshaft

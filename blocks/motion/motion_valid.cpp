#include "blocks/motion/motion_valid.hpp"

#include "blocks/axis/axis_valid.hpp"

namespace lineshaft {

namespace {

/// In one list of one axis, or in none.
bool is_where_it_says(const Job& job, const KeptState& machine) {
    const Context& context = machine.context;
    const std::int64_t place = context.place_of(job);
    int lists = 0;
    for (std::int64_t n = 0; n < context.blocks; ++n) {
        if (!is_instance<Axis>(context, n)) continue;
        const Axis& axis = context.instance<Axis>(n);
        lists += leads_to(axis.inbox, place, machine);
        lists += leads_to(axis.queue, place, machine);
    }
    return lists == (job.in == JobPlace::no_list ? 0 : 1);
}

}  // namespace

bool is_valid(const CommandState& command) {
    return are_booleans(command.last_execute, command.told, command.started, command.execute,
                        command.done, command.busy, command.active, command.command_aborted,
                        command.error, command.reached, command.reached_shown) &&
           is_valid(command.refusal);
}

bool is_valid(const CommandBlock& command, const KeptState& machine) {
    return is_valid(static_cast<const CommandState&>(command)) &&
           are_booleans(command.continuous_update, command.updating, command.ends) &&
           is_valid(command.pins, machine) && is_valid(command.job, machine) &&
           (!machine.is_live || is_where_it_says(command.job, machine));
}

void mend(CommandBlock& command, const KeptState&) {
    command.job.in = JobPlace::no_list;
    command.job.previous = command.job.next = nowhere;
    if (is_end(command.job.progress)) return;
    command.started = command.busy = command.active = command.reached = false;
}

bool is_valid(const Home& home, const KeptState& machine) {
    return are_booleans(home.signalled, home.last_signal) &&
           is_valid(static_cast<const CommandBlock&>(home), machine);
}

bool is_valid(const CamTableSelect& select, const KeptState&) {
    return are_booleans(select.last_execute);
}

bool is_valid(const ReadMotionState& read, const KeptState& machine) {
    return are_booleans(read.has_looked) && machine.is_moment(read.last_time);
}

bool is_valid(const TouchProbe& probe, const KeptState& machine) {
    return are_booleans(probe.last_execute, probe.last_trigger, probe.told) &&
           is_one_of(probe.phase, TouchProbe::Phase::refused) && machine.is_moment(probe.moment) &&
           machine.is_moment(probe.recorded_time) && probe.motion.is_possible(machine);
}

bool is_valid(const DigitalCamSwitch& cam_switch, const KeptState& machine) {
    const auto may_go_on = [&](const SwitchedCam& cam) {
        return are_booleans(cam.inside, cam.first_holds, cam.last_holds, cam.on, cam.forward) &&
               machine.is_moment(cam.until);
    };
    const auto is_moment = [&](std::int64_t time) { return machine.is_moment(time); };
    return are_booleans(cam_switch.knows_cams) && cam_switch.motion.is_possible(machine) &&
           (!cam_switch.knows_cams || !cam_switch.motion.is_empty()) &&
           std::ranges::all_of(cam_switch.cams, may_go_on) &&
           std::ranges::all_of(cam_switch.on_times, is_moment) &&
           std::ranges::all_of(cam_switch.off_times, is_moment);
}

bool is_valid(const DigitalOutputs& outputs, const KeptState& machine) {
    return std::ranges::all_of(outputs.writes, [&](const DigitalOutputs::Write& write) {
        return are_booleans(write.waits, write.value) && is_count(write.ticket) &&
               is_count(write.taken) && machine.is_task(write.task) && is_count(write.scan);
    });
}

void mend(DigitalOutputs& outputs, const KeptState&) {
    for (DigitalOutputs::Write& write : outputs.writes) {
        write.waits = false;
        write.taken = write.ticket;
    }
}

bool is_valid(const WriteDigitalOutput& write, const KeptState&) {
    return are_booleans(write.last_execute, write.waits, write.told) && is_count(write.ticket) &&
           write.written >= 0 && write.written <= digital_signals;
}

}  // namespace lineshaft

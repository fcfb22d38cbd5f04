#include "blocks/axis/axis_valid.hpp"

#include <set>
#include <vector>

#include "blocks/axis/cam_table.hpp"
#include "blocks/axis/written_cam.hpp"

namespace lineshaft {

namespace {

bool is_valid(const Moment& moment, const KeptState& machine) {
    constexpr double longest = 1e-6;
    return machine.is_moment(moment.time) && moment.later >= 0 && moment.later <= longest;
}

bool is_duration(double seconds) {
    return std::isfinite(seconds) && seconds >= 0;
}

bool is_valid(const MotionPlan& plan) {
    return plan.count <= MotionPlan::most_phases && is_duration(plan.duration);
}

bool is_valid(const PointMotion& motion, const KeptState& machine) {
    return is_valid(motion.start, machine) && is_valid(motion.plan) &&
           is_duration(motion.duration) && (motion.phase == 0 || motion.phase < motion.plan.count);
}

bool is_valid(const VelocityMotion& motion, const KeptState& machine) {
    const auto most = static_cast<int>(motion.ramp.phases.size());
    return is_valid(motion.start, machine) && motion.ramp.count >= 0 && motion.ramp.count <= most &&
           is_duration(motion.ramp.duration);
}

bool is_valid(const MasterLink& link, const KeptState& machine) {
    return is_one_of(link.source, MasterValueSource::actual_value) && link.axis >= -1 &&
           (link.axis == -1 || is_instance<Axis>(machine.context, link.axis));
}

/// With points, so that it can be followed.
bool is_cam(std::int64_t table, const KeptState& machine) {
    if (!is_instance<CamTable>(machine.context, table)) return false;
    return !machine.context.instance<CamTable>(table).cam(false).points.empty();
}

bool is_valid(const ProfileMotion& motion, bool is_followed, const KeptState& machine) {
    if (!is_valid(motion.start, machine) || !is_duration(motion.duration) ||
        !is_one_of(motion.of, ProfileOf::acceleration))
        return false;
    return !is_followed || (is_cam(motion.table, machine) && motion.time_scale > 0);
}

bool is_valid(const Shortage& shortage) {
    return is_one_of(shortage.limit, CurveFault::jerk);
}

bool is_valid(const SyncMotion& sync, bool is_followed, const KeptState& machine) {
    if (!is_one_of(sync.law, SyncMotion::Law::cammed) ||
        !is_one_of(sync.stage, SyncMotion::Stage::in_sync) || !is_valid(sync.coupling, machine) ||
        !is_valid(sync.start, machine) || !is_valid(sync.transition.plan) ||
        !is_valid(sync.shifting, machine) || !is_one_of(sync.way, SyncMotion::Way::rest) ||
        !is_valid(sync.timed.plan) || !is_valid(sync.looked, machine))
        return false;
    if (!is_followed) return true;
    return sync.coupling.master.axis >= 0 &&
           (sync.law != SyncMotion::Law::cammed ||
            !WrittenCam::find(machine.context, CamTableId::of(sync.coupling.cam)).points.empty());
}

bool is_valid(const Axis::Running& running, const KeptState& machine) {
    if (!running.exists()) return true;
    return is_job(running.place, JobFor::axis, machine) && is_count(running.ticket) &&
           is_valid(running.request, machine);
}

bool lists_are_valid(const Axis& axis, const KeptState& machine) {
    return lists_are_valid(axis.inbox, axis.queue, JobFor::axis, machine);
}

/// A slave makes up for the steps since its last scan: not for more than a task would leave out.
bool steps_are_few(const Axis& axis, const KeptState& machine) {
    const SyncMotion& sync = axis.sync;
    const bool steps = axis.doing == Axis::Doing::following_axes && sync.in_steps != 0 &&
                       sync.stage == SyncMotion::Stage::in_transition;
    constexpr double most = 1e6;
    return !steps || (axis.transition_quantum > 0 &&
                      sync.start.until(machine.now) <= most * axis.transition_quantum);
}

bool counts_are_valid(const Axis& axis, const KeptState& machine) {
    const auto is_axis = [&](std::int64_t number) {
        return number == nowhere || is_instance<Axis>(machine.context, number);
    };
    return is_count(axis.followers) && are_booleans(axis.is_counted) && is_axis(axis.counted) &&
           is_axis(axis.counted_second);
}

/// Looks at the axis and all that it follows as it sees them, which may follow each other
/// (Axis::follow).
bool masters_are_valid(const Axis& axis, const KeptState& machine) {
    std::vector<const Axis*> open{&axis};
    std::set<std::int64_t> seen;
    while (!open.empty()) {
        const Axis& follower = *open.back();
        open.pop_back();
        if (follower.doing != Axis::Doing::following_axes) continue;
        for (const MasterLink* link :
             {&follower.sync.coupling.master, &follower.sync.coupling.second}) {
            if (!is_valid(*link, machine)) return false;
            if (link->axis < 0 || !seen.insert(link->axis).second) continue;
            open.push_back(&machine.context.seen_instance<Axis>(link->axis));
        }
    }
    return true;
}

bool motions_are_valid(const Axis& axis, const KeptState& machine) {
    using Doing = Axis::Doing;
    return is_one_of(axis.doing, Doing::following_set_points) &&
           is_valid(axis.velocity_motion, machine) && is_valid(axis.point_motion, machine) &&
           is_valid(axis.added_motion, machine) && is_duration(axis.added_passed) &&
           is_valid(axis.profile_motion, axis.doing == Doing::following_profile, machine) &&
           is_valid(axis.sync, axis.doing == Doing::following_axes, machine);
}

}  // namespace

bool is_job(std::int64_t place, JobFor whom, const KeptState& machine) {
    return machine.is_link(place) && machine.context.at<JobState>(place).whom == whom;
}

bool lists_are_valid(const JobList& inbox, const JobList& queue, JobFor whom,
                     const KeptState& machine) {
    std::set<std::int64_t> seen;
    const auto is_list = [&](const JobList& list, JobPlace in) {
        std::int64_t last = nowhere;
        for (std::int64_t place = list.first; place != nowhere;) {
            if (!is_job(place, whom, machine) || !seen.insert(place).second) return false;
            const JobState& job = machine.context.at<JobState>(place);
            if (job.in != in || job.previous != last) return false;
            last = place;
            place = job.next;
        }
        return last == list.last;
    };
    return is_list(inbox, JobPlace::inbox) && is_list(queue, JobPlace::queue);
}

bool leads_to(const JobList& list, std::int64_t job, const KeptState& machine) {
    std::int64_t place = list.first;
    for (std::size_t n = 0; n <= machine.links->size() && machine.is_link(place); ++n) {
        if (place == job) return true;
        place = machine.context.at<JobState>(place).next;
    }
    return false;
}

bool is_valid(const JobState& job, JobFor whom, const KeptState& machine) {
    return job.whom == whom && is_count(job.ticket) && machine.is_task(job.task) &&
           is_one_of(job.in, JobPlace::queue) && is_one_of(job.progress, Progress::failed) &&
           is_one_of(job.before, Progress::failed) &&
           (job.told_by == nowhere || machine.is_task(job.told_by)) && is_valid(job.error) &&
           (job.previous == nowhere || machine.is_link(job.previous)) &&
           (job.next == nowhere || machine.is_link(job.next));
}

bool is_valid(MotionError error) {
    return is_one_of(error, static_cast<MotionError>(std::size(motion_error_names) - 1));
}

bool is_valid(const Coupling& coupling, const KeptState& machine) {
    return is_valid(coupling.master, machine) && is_valid(coupling.second, machine) &&
           is_one_of(coupling.combine, CombineMode::subtract) &&
           is_one_of(coupling.transition, TransitionMode::step) &&
           is_one_of(coupling.sync_mode, SyncMode::slow_down) &&
           is_one_of(coupling.start_mode, StartMode::direct);
}

bool is_valid(const Request& request, const KeptState& machine) {
    if (request.command < Command::none ||
        static_cast<std::size_t>(request.command) > state_table().size() ||
        !is_one_of(request.mode, BufferMode::blending_high) ||
        !is_one_of(request.direction, MoveDirection::current) ||
        !is_one_of(request.homing, HomingMode::signalled) ||
        !is_one_of(request.aborted_by, AbortedBy::neither) ||
        !is_one_of(request.reference, Referencing::unknown) ||
        !is_one_of(request.rules, CommandRules::softmotion) || !is_valid(request.coupling, machine))
        return false;
    const std::int64_t table = CamTableId::of(request.coupling.cam).table;
    return !is_profile(request.command) || table < 0 ||
           is_instance<CamTable>(machine.context, table);
}

bool is_valid(const Job& job, const KeptState& machine) {
    return is_valid(job, JobFor::axis, machine) && is_valid(job.request, machine) &&
           is_valid(job.shortage);
}

bool is_valid(const Axis& axis, const KeptState& machine) {
    return !axis.misfit({}) && motions_are_valid(axis, machine) && is_valid(axis.active, machine) &&
           is_valid(axis.added, machine) && is_valid(axis.phased, machine) &&
           is_valid(axis.overriding, machine) && machine.is_task(axis.task) &&
           is_count(axis.scan_index) && axis.powered_in >= nowhere &&
           machine.is_moment(axis.scan_time) && machine.is_moment(axis.shown.time) &&
           machine.is_moment(axis.led_at) && is_valid(axis.shortage) &&
           is_count(axis.scan_interval) && is_count(axis.renamed) &&
           is_one_of(axis.switched_by, CommandRules::softmotion) && is_count(axis.trigger_aborts) &&
           is_count(axis.commands) && counts_are_valid(axis, machine) &&
           masters_are_valid(axis, machine) && steps_are_few(axis, machine) &&
           (!machine.is_live || lists_are_valid(axis, machine));
}

void mend(Axis& axis, const KeptState& machine) {
    axis.wake_up(machine.now);
}

bool is_valid(const ServoDrive& drive, const KeptState& machine) {
    return are_booleans(drive.checked, drive.in_simulation, drive.first_scan, drive.last_home,
                        drive.has_velocity) &&
           drive.newest >= 0 && drive.newest <= ServoDrive::longest_delay &&
           is_one_of(drive.contradiction, ServoError::no_time_constant) &&
           machine.is_moment(drive.last_time);
}

}  // namespace lineshaft

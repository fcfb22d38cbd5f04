#include "blocks/group/group_valid.hpp"

#include <algorithm>
#include <cmath>

#include "blocks/axis/axis_valid.hpp"
#include "blocks/motion/motion_valid.hpp"

namespace lineshaft {

namespace {

template <class Block>
bool is_block_or_none(std::int64_t number, const KeptState& machine) {
    return number == nowhere || is_instance<Block>(machine.context, number);
}

bool is_valid(const GroupRequest& request, const KeptState& machine) {
    return request.command >= GroupCommand::none &&
           static_cast<std::size_t>(request.command) <= group_state_table().size() &&
           is_one_of(request.mode, BufferMode::blending_high) &&
           is_one_of(request.corner, CornerMode::corner_deviation) &&
           is_one_of(request.coordinates, CoordSystem::product) &&
           is_one_of(request.circle, CircleMode::radius) &&
           is_one_of(request.choice, PathChoice::counter_clockwise) &&
           is_block_or_none<Axis>(request.axis, machine) &&
           is_block_or_none<PathTable>(request.table, machine);
}

bool is_valid(const PathFrame& frame) {
    for (std::size_t i = 0; i < path_space; ++i) {
        if (!std::isfinite(frame.shift[i])) return false;
        for (const double part : frame.turn[i])
            if (!(std::abs(part) <= 1)) return false;
    }
    return true;
}

/// What its command names.
bool has_all(const GroupRequest& request) {
    return (request.command != GroupCommand::add_axis || request.axis != nowhere) &&
           (request.command != GroupCommand::move_path || request.table != nowhere);
}

bool is_sent(const GroupJob& job) {
    return job.ticket > 0;
}

/// Its pieces are of the path, and the rows of its table.
bool is_valid(const GroupJob& job, const KeptState& machine) {
    if (!is_valid(job, JobFor::group, machine) || !is_count(job.first_piece) ||
        !is_count(job.end_piece) || !is_count(job.rows) || !is_valid(job.frame))
        return false;
    if (!is_sent(job)) return job.request == GroupRequest{};
    if (!is_valid(job.request, machine) || !has_all(job.request)) return false;
    if (job.request.command != GroupCommand::move_path) return true;
    return job.rows <= machine.context.instance<PathTable>(job.request.table).table.size;
}

bool is_valid(const AxesGroup::Holder& holder, const KeptState& machine) {
    return !holder.exists() ||
           (is_job(holder.place, JobFor::group, machine) && is_count(holder.ticket) &&
            holder.command > GroupCommand::none && holder.command <= GroupCommand::set_override);
}

bool is_valid(const MotionPlan& plan) {
    return plan.count <= MotionPlan::most_phases && std::isfinite(plan.duration) &&
           plan.duration >= 0;
}

bool is_valid(const PathCourse& course) {
    return course.count <= PathCourse::most_phases && std::isfinite(course.duration) &&
           course.duration >= 0;
}

bool is_valid(const PathPiece& piece) {
    return is_one_of(piece.curve.kind, PathCurveKind::spline) && piece.curve.length > 0 &&
           std::isfinite(piece.curve.length) && std::isfinite(piece.begin);
}

/// It ends in one of the stretches, or the path is over.
bool is_valid(const PathLeg& leg, const Path& path) {
    const bool has_goal = leg.goal >= path.stretch && leg.goal < path.stretches;
    return is_valid(leg.plan) && is_valid(leg.course) && std::isfinite(leg.base) &&
           std::isfinite(leg.end) && !std::isnan(leg.ripe) &&
           (has_goal || leg.plan.count + leg.course.count == 0);
}

bool is_valid(const PathStretch& stretch, std::uint64_t number, const Path& path) {
    return is_good(stretch.box) && is_good(stretch.span) && std::isfinite(stretch.begin) &&
           std::isfinite(stretch.end) && stretch.target >= number &&
           stretch.target < path.stretches;
}

/// Pieces and stretches under way are in the ring.
bool is_valid(const Path& path, std::span<const PathPiece> ring) {
    constexpr std::uint64_t most = std::uint64_t{1} << 62;
    if (path.count > most || path.first > path.count || path.count - path.first > ring.size() ||
        path.stretch > path.stretches || path.known > path.stretches || path.sure > path.known ||
        path.stretches - path.stretch > path.count - path.first ||
        !are_booleans(path.halted, path.stale, path.fresh, path.lost) ||
        !is_valid(path.leg, path) || !std::isfinite(path.time) || path.time < 0 ||
        std::isnan(path.again))
        return false;
    for (std::uint64_t k = path.first; k < path.count; ++k)
        if (!is_valid(ring[k % ring.size()])) return false;
    for (std::uint64_t k = path.stretch; k < path.stretches; ++k)
        if (!is_valid(ring[k % ring.size()].stretch, k, path)) return false;
    return true;
}

bool lists_are_valid(const AxesGroup& group, const KeptState& machine) {
    return lists_are_valid(group.inbox, group.queue, JobFor::group, machine) &&
           lists_are_valid({}, group.aside.queue, JobFor::group, machine);
}

/// In one list of one group, or in none.
bool is_where_it_says(const GroupJob& job, const KeptState& machine) {
    const Context& context = machine.context;
    const std::int64_t place = context.place_of(job);
    int lists = 0;
    for (std::int64_t n = 0; n < context.blocks; ++n) {
        if (!is_instance<AxesGroup>(context, n)) continue;
        const AxesGroup& group = context.instance<AxesGroup>(n);
        lists += leads_to(group.inbox, place, machine);
        lists += leads_to(job.is_aside != 0 ? group.aside.queue : group.queue, place, machine);
    }
    return lists == (job.in == JobPlace::no_list ? 0 : 1);
}

}  // namespace

bool is_valid(const AxesGroup& group, const KeptState& machine) {
    for (const std::int64_t axis : group.axes)
        if (!is_block_or_none<Axis>(axis, machine)) return false;
    return is_valid(group.frame) && (group.ring_in_use == 0 || group.ring_in_use == 1) &&
           is_valid(group.path, group.ring()) &&
           is_valid(group.aside.path,
                    group.rings[static_cast<std::size_t>(1 - group.ring_in_use)]) &&
           is_valid(group.holder, machine) && is_valid(group.interrupter, machine) &&
           is_valid(group.overriding, machine) && is_valid(group.resetter, machine) &&
           is_valid(group.leaver, machine) && machine.is_task(group.task) &&
           is_count(group.scan_index) && machine.is_moment(group.time) &&
           (!machine.is_live || lists_are_valid(group, machine));
}

void mend(AxesGroup& group, const KeptState& machine) {
    if (!lists_are_valid(group, machine)) group.inbox = group.queue = group.aside.queue = {};
}

bool is_valid(const GroupCommandBlock& command, const KeptState& machine) {
    return is_valid(static_cast<const CommandState&>(command)) && is_valid(command.pins, machine) &&
           is_valid(command.job, machine) &&
           (!machine.is_live || is_where_it_says(command.job, machine));
}

void mend(GroupCommandBlock& command, const KeptState& machine) {
    if (is_where_it_says(command.job, machine)) return;
    command.job.in = JobPlace::no_list;
    command.job.previous = command.job.next = nowhere;
}

}  // namespace lineshaft

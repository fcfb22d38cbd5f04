#include <algorithm>
#include <cmath>

#include "blocks/group/axes_group.hpp"
#include "blocks/group/path_table.hpp"
#include "blocks/path/path_spline.hpp"

namespace lineshaft {

namespace {

bool is_relative(GroupCommand command) {
    using enum GroupCommand;
    return command == move_linear_relative || command == move_circular_relative ||
           command == move_direct_relative;
}

PathVector sum(const PathVector& a, const PathVector& b, double factor = 1) {
    PathVector out{};
    for (std::size_t i = 0; i < most_path_axes; ++i) out[i] = a[i] + factor * b[i];
    return out;
}

/// What positions are rounded to at the most: README.md, "Moves".
double rounding_in(AxisUnit unit) {
    return unit == AxisUnit::mm || unit == AxisUnit::deg ? 0.01 : 1e-5;
}

PathFault arc_of(const GroupRequest& request, const PathVector& from, const PathVector& to,
                 double rounding, PathCurve& out) {
    const bool relative = is_relative(request.command);
    const PathVector a = in_space(from), b = in_space(to);
    const PathVector auxiliary =
        in_space(relative ? sum(from, request.auxiliary) : request.auxiliary);
    const double turn = request.choice == PathChoice::clockwise ? -1 : 1;
    PathFault fault = PathFault::none;
    if (request.circle == CircleMode::border)
        fault = arc_through(a, auxiliary, b, out);
    else if (request.circle == CircleMode::centre)
        fault = arc_about(a, auxiliary, b, sum({}, normal_upwards(a, auxiliary, b), turn), rounding,
                          out);
    else
        fault = arc_of_radius(a, b, sum({}, sum(auxiliary, a, -1), turn), rounding, out);
    if (fault == PathFault::none) let_follow(out, from, to);
    return fault;
}

PathFault curve_of(const GroupRequest& request, const PathVector& from, double rounding,
                   PathCurve& out) {
    using enum GroupCommand;
    const GroupCommand command = request.command;
    const PathVector to = is_relative(command) ? sum(from, request.target) : request.target;
    if (command == move_circular_absolute || command == move_circular_relative)
        return arc_of(request, from, to, rounding, out);
    return line_to(from, to, out, path_space);
}

PathBlend blend_of(BufferMode mode) {
    if (mode == BufferMode::blending_previous) return PathBlend::previous;
    if (mode == BufferMode::blending_next) return PathBlend::next;
    return mode == BufferMode::blending_high ? PathBlend::high : PathBlend::low;
}

/// Rotary axes alone, or axes each for itself: the path has no limits then, only its axes.
bool is_free(const GroupRequest& request, const PathCurve& curve) {
    using enum GroupCommand;
    if (request.command == move_direct_absolute || request.command == move_direct_relative)
        return true;
    return !curve.is_in_space();
}

}  // namespace

MotionError motion_error_of(PathFault fault) {
    switch (fault) {
        case PathFault::none:
        case PathFault::no_length:
            return MotionError::none;
        case PathFault::no_arc:
            return MotionError::no_arc;
        case PathFault::limit_not_positive:
            return MotionError::limit_not_positive;
        case PathFault::not_finite:
        case PathFault::not_joined:
        case PathFault::full:
            break;
    }
    return MotionError::not_finite;
}

/// Whatever the place where it will begin.
MotionError AxesGroup::check(const Context& context, const GroupRequest& request,
                             const PathFrame& of) const {
    const auto chosen = [](double asked, double otherwise) {
        return asked < 0 ? otherwise : asked;
    };
    if (!(chosen(request.velocity, 1) > 0) || !(chosen(request.acceleration, 1) > 0) ||
        !(chosen(request.deceleration, 1) > 0) || !(chosen(request.jerk, 1) > 0))
        return MotionError::limit_not_positive;
    if (!(request.corner_parameter >= 0)) return MotionError::out_of_range;
    const auto has_axes = [&](const PathVector& x) {
        for (std::size_t i = 0; i < most_path_axes; ++i)
            if (axes[i] == nowhere && x[i] != 0) return false;
        return true;
    };
    const PathVector& target = request.target;
    if (request.command != GroupCommand::move_path)
        return has_axes(is_relative(request.command) ? of.direction(target) : of.place(target))
                   ? MotionError::none
                   : MotionError::out_of_range;
    const PathTable& table = context.instance<PathTable>(request.table);
    if (table.unit != unit) return MotionError::unit_of_group;
    for (std::size_t i = 0; i < static_cast<std::size_t>(table.table.size); ++i)
        if (!has_axes(of.place(table.table.rows[i].target()))) return MotionError::out_of_range;
    return MotionError::none;
}

/// Puts what waits into the path, as far as there is room.
void AxesGroup::lay(const Context& context) {
    if (braking != 0) return;
    for (std::int64_t place = queue.first; place != nowhere;) {
        GroupJob& job = context.at<GroupJob>(place);
        place = job.next;
        if (job.is_laid != 0) continue;
        if (following == 0) find_axes(context);
        if (const MotionError why = lay(context, job); why != MotionError::none) {
            unlink(context, job, queue);
            tell(job, Progress::failed, why);
        } else if (job.is_laid == 0) {
            break;
        }
    }
    look_at_moves(context);
    if (following == 0 && queue.first == nowhere && state == GroupState::moving)
        state = GroupState::standby;
}

MotionError AxesGroup::lay(const Context& context, GroupJob& job) {
    if (job.request.command == GroupCommand::move_path) return lay_table(context, job);
    if (!has_room(most_transition_parts)) return MotionError::none;
    PathCurve curve;
    const PathFault fault =
        curve_of(job.request, job.frame.inverse().place(end_point), rounding_in(unit), curve);
    job.first_piece = job.end_piece = static_cast<std::int64_t>(path.count);
    if (fault == PathFault::none) {
        if (const MotionError why = append(context, job.request, job.frame.curve(curve), false);
            why != MotionError::none)
            return why;
    } else if (const MotionError why = motion_error_of(fault); why != MotionError::none) {
        return why;
    }
    job.end_piece = static_cast<std::int64_t>(path.count);
    job.is_laid = 1;
    return MotionError::none;
}

/// Where the path begins.
void AxesGroup::find_axes(const Context& context) {
    position = turned = {};
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const Axis* const led = axis(context, i);
        if (!led) continue;
        position[i] = led->position;
        const double turns = led->total().position - position[i];
        turned[i] = led->modulo ? std::round(turns / led->period) * led->period : turns;
    }
    end_point = position;
}

MotionError AxesGroup::begin_to_follow(const Context& context) {
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (const Axis* const led = axis(context, i))
            if (const MotionError why = led->cannot_follow(); why != MotionError::none) return why;
    for (std::size_t i = 0; i < most_path_axes; ++i)
        if (Axis* const led = axis(context, i)) led->begin_to_follow({time});
    following = 1;
    return MotionError::none;
}

MotionError AxesGroup::append(const Context& context, const GroupRequest& request,
                              const PathCurve& curve, bool is_within) {
    if (const MotionError why = stays_inside(context, curve); why != MotionError::none) return why;
    PathLimits limits = limits_of(context, request);
    constexpr double none = 1e300;
    if (is_free(request, curve)) limits.path = {none, none, none};
    if (following == 0)
        if (const MotionError why = begin_to_follow(context); why != MotionError::none) return why;
    const PathFault fault =
        path.append(ring(), curve, limits, joint_of(request, is_within, curve, limits));
    if (fault == PathFault::none) end_point = curve.end;
    return motion_error_of(fault);
}

/// The lesser of acceleration and deceleration counts for both ways, of an axis as of the path.
PathLimits AxesGroup::limits_of(const Context& context, const GroupRequest& request) const {
    const auto chosen = [](double asked, double otherwise) {
        return asked < 0 ? otherwise : asked;
    };
    PathLimits limits;
    const double both_ways = chosen(request.acceleration, default_acceleration);
    limits.path = {chosen(request.velocity, default_velocity),
                   std::min(both_ways, chosen(request.deceleration, both_ways)),
                   chosen(request.jerk, default_jerk)};
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const Axis* const led = axis(context, i);
        if (!led) continue;
        const Dynamics d = led->defaults();
        limits.axes[i] = {d.velocity, std::min(d.acceleration, d.deceleration), d.jerk};
    }
    return limits;
}

MotionError AxesGroup::stays_inside(const Context& context, const PathCurve& curve) const {
    const PathVector from = curve.at(0).position;
    for (std::size_t i = 0; i < most_path_axes; ++i) {
        const Axis* const led = axis(context, i);
        if (!led || curve.share(i) == 0) continue;
        const PathCurve::Extent extent = curve.extent(i);
        const double by = turned[i];
        if (const MotionError why = led->cannot_run(from[i] + by, curve.end[i] + by,
                                                    extent.least + by, extent.greatest + by);
            why != MotionError::none)
            return why;
    }
    return MotionError::none;
}

/// Between points of a table as between moves that are blended.
PathJoint AxesGroup::joint_of(const GroupRequest& request, bool is_within, const PathCurve& curve,
                              const PathLimits& limits) const {
    if (path.finished()) return {};
    PathJoint joint;
    if (!is_within && request.mode <= BufferMode::buffered) joint.velocity = 0;
    const PathPiece& last = ring()[(path.count - 1) % look_ahead];
    const PathCurve& before = last.curve;
    joint.blend = is_within ? PathBlend::low : blend_of(request.mode);
    const bool lines = before.kind == PathCurveKind::line && curve.kind == PathCurveKind::line;
    if (!before.is_line_or_arc() || !curve.is_line_or_arc() || joint.velocity == 0) return joint;
    const double parameter = request.corner_parameter;
    if (request.corner == CornerMode::corner_distance) joint.distance = parameter;
    if (request.corner == CornerMode::corner_deviation)
        joint.distance = PathJoint::any, joint.deviation = parameter;
    if (request.corner == CornerMode::start_velocity && lines)
        joint.distance = corner_distance_at(parameter, before, curve,
                                            limits_between(last.limits, limits, joint.blend));
    return joint;
}

}  // namespace lineshaft

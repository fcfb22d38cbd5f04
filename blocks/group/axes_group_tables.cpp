#include "blocks/group/axes_group.hpp"
#include "blocks/group/path_table.hpp"
#include "blocks/path/path_spline.hpp"

namespace lineshaft {

namespace {

/// A row of a table as a move of its own.
GroupRequest row_of(const GroupRequest& request, const PathTablePoint& point) {
    GroupRequest row = request;
    row.command = point.kind == PathPointKind::arc ? GroupCommand::move_circular_absolute
                                                   : GroupCommand::move_linear_absolute;
    row.circle = CircleMode::border;
    row.target = point.target();
    row.auxiliary = point.auxiliary();
    return row;
}

using Curves = std::array<PathCurve, most_spline_parts>;

/// How a spline passes the point of a row: as the line or arc behind it begins, else along the
/// parabola through the points before and behind.
PathPoint passage(const GroupRequest& request, const PathTable::Points& points, std::size_t i,
                  const PathVector& from) {
    const PathVector at = points.rows[i].target();
    if (i + 1 == static_cast<std::size_t>(points.size)) return waypoint(from, at, at);
    const PathTablePoint& next = points.rows[i + 1];
    PathCurve behind;
    if (next.kind != PathPointKind::spline &&
        curve_of(row_of(request, next), at, behind) == PathFault::none)
        return behind.at(0);
    return waypoint(from, at, next.target());
}

/// The curves from a point to that of row i; `before` is the curve that ends there, or none.
PathFault curves_of(const GroupRequest& request, const PathTable::Points& points, std::size_t i,
                    const PathVector& from, const PathCurve* before, Curves& out,
                    std::size_t& count) {
    count = 1;
    const PathTablePoint& row = points.rows[i];
    if (row.kind != PathPointKind::spline) return curve_of(row_of(request, row), from, out[0]);
    if (row.target() == from) return PathFault::no_length;
    const PathPoint begin =
        before ? before->at(before->length) : waypoint(from, from, row.target());
    count = spline_between(begin, passage(request, points, i, from), out);
    return count > 0 ? PathFault::none : PathFault::not_finite;
}

}  // namespace

/// The curve that the next row goes on from, where that is not to be a stop.
const PathCurve* AxesGroup::last_curve(const GroupJob& job) const {
    if (path.finished() || (job.rows == 0 && job.request.mode <= BufferMode::buffered))
        return nullptr;
    return &ring[(path.count - 1) % ring.size()].curve;
}

/// Before it begins.
MotionError AxesGroup::look_through(const Context& context, const GroupJob& job) const {
    const PathTable::Points& points = context.instance<PathTable>(job.request.table).table;
    Curves curves;
    PathCurve last;
    const PathCurve* before = last_curve(job);
    PathVector from = end_point;
    for (std::size_t i = 0; i < static_cast<std::size_t>(points.size); ++i) {
        std::size_t count = 0;
        const PathFault fault = curves_of(job.request, points, i, from, before, curves, count);
        if (const MotionError why = motion_error_of(fault); why != MotionError::none) return why;
        if (fault != PathFault::none) continue;
        for (std::size_t k = 0; k < count; ++k)
            if (const MotionError why = stays_inside(context, curves[k]); why != MotionError::none)
                return why;
        last = curves[count - 1];
        before = &last;
        from = last.end;
    }
    return MotionError::none;
}

MotionError AxesGroup::lay_table(const Context& context, GroupJob& job) {
    const PathTable::Points& points = context.instance<PathTable>(job.request.table).table;
    if (job.rows == 0) {
        job.first_piece = static_cast<std::int64_t>(path.count);
        if (const MotionError why = look_through(context, job); why != MotionError::none)
            return why;
    }
    Curves curves;
    for (; job.rows < points.size && has_room(most_spline_parts); ++job.rows) {
        const auto i = static_cast<std::size_t>(job.rows);
        std::size_t count = 0;
        if (curves_of(job.request, points, i, end_point, last_curve(job), curves, count) !=
            PathFault::none)
            continue;
        const GroupRequest row = row_of(job.request, points.rows[i]);
        for (std::size_t k = 0; k < count; ++k)
            if (const MotionError why = append(context, row, curves[k], job.rows > 0 || k > 0);
                why != MotionError::none)
                return why;
    }
    job.end_piece = static_cast<std::int64_t>(path.count);
    job.is_laid = job.rows == points.size ? 1 : 0;
    return MotionError::none;
}

}  // namespace lineshaft

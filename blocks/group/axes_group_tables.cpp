#include "blocks/group/axes_group.hpp"
#include "blocks/group/path_table.hpp"
#include "blocks/path/path_spline.hpp"

namespace lineshaft {

namespace {

PathRows rows_of(const PathTable::Points& points, const PathVector& start) {
    return {{points.rows.data(), static_cast<std::size_t>(points.size)}, start};
}

}  // namespace

/// The next row is not to begin with a stop.
bool AxesGroup::goes_on(const GroupJob& job) const {
    return !path.finished() && (job.rows > 0 || job.request.mode > BufferMode::buffered);
}

/// The curve that the next row goes on from, in the coordinates of its move.
PathCurve AxesGroup::last_curve(const GroupJob& job) const {
    return goes_on(job) ? job.frame.inverse().curve(ring()[(path.count - 1) % look_ahead].curve)
                        : PathCurve{};
}

/// Before it begins.
MotionError AxesGroup::look_through(const Context& context, const GroupJob& job) const {
    const PathTable::Points& points = context.instance<PathTable>(job.request.table).table;
    PathRowCurves curves;
    PathCurve last = last_curve(job);
    const PathCurve* before = goes_on(job) ? &last : nullptr;
    const PathRows rows = rows_of(points, job.start);
    PathVector from = job.start;
    for (std::size_t i = 0; i < rows.rows.size(); ++i) {
        std::size_t count = 0;
        const PathFault fault = curves_of(rows, i, from, before, curves, count);
        if (const MotionError why = motion_error_of(fault); why != MotionError::none) return why;
        if (fault != PathFault::none) continue;
        for (std::size_t k = 0; k < count; ++k)
            if (const MotionError why = stays_inside(context, job.frame.curve(curves[k]));
                why != MotionError::none)
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
        job.start = job.frame.inverse().place(end_point);
        if (const MotionError why = look_through(context, job); why != MotionError::none)
            return why;
    }
    PathRowCurves curves;
    for (; job.rows < points.size; ++job.rows) {
        const auto i = static_cast<std::size_t>(job.rows);
        const bool is_spline = points.rows[i].kind >= PathPointKind::spline;
        if (!has_room(is_spline ? most_spline_parts : most_transition_parts)) break;
        std::size_t count = 0;
        const PathCurve last = last_curve(job);
        if (curves_of(rows_of(points, job.start), i, job.frame.inverse().place(end_point),
                      goes_on(job) ? &last : nullptr, curves, count) != PathFault::none)
            continue;
        for (std::size_t k = 0; k < count; ++k)
            if (const MotionError why =
                    append(context, job.request, job.frame.curve(curves[k]), job.rows > 0 || k > 0);
                why != MotionError::none)
                return why;
    }
    job.end_piece = static_cast<std::int64_t>(path.count);
    job.is_laid = job.rows == points.size ? 1 : 0;
    return MotionError::none;
}

}  // namespace lineshaft

#include "blocks/group/path_table.hpp"

#include "blocks/inputs.hpp"
#include "blocks/path/path_cubic.hpp"

namespace lineshaft {

namespace {

PathVector difference(const PathVector& a, const PathVector& b) {
    PathVector out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] - b[i];
    return out;
}

/// Neither turns back nor stands.
bool goes_on(const PathVector& a, const PathVector& b) {
    return in_space(a) != PathVector{} && in_space(b) != PathVector{} && !turns_back(a, b);
}

/// From the point before row k to its own.
PathVector way(const PathRows& table, std::size_t k) {
    return difference(table.knot(k + 1), table.knot(k));
}

/// A row of rotary axes alone is a line.
bool is(PathPointKind kind, const PathRows& table, std::size_t k) {
    return k < table.rows.size() && table.rows[k].kind == kind &&
           in_space(way(table, k)) != PathVector{};
}

/// Row k begins where the cubic spline of the row before ends, and is a part of it.
bool goes_on_cubic(const PathRows& table, std::size_t k) {
    return k > 0 && is(PathPointKind::cubic, table, k) && is(PathPointKind::cubic, table, k - 1) &&
           goes_on(way(table, k - 1), way(table, k));
}

/// Where the part that row k is of a cubic spline begins, or ends.
PathKnot knot_of(const PathRows& table, std::size_t k, bool at_end) {
    const std::size_t at = k + (at_end ? 1 : 0);
    std::size_t first = k, last = k + 1;
    while (at - first < cubic_reach && goes_on_cubic(table, first)) --first;
    while (last - at < cubic_reach && goes_on_cubic(table, last)) ++last;
    std::array<PathVector, 2 * cubic_reach + 1> points;
    for (std::size_t i = first; i <= last; ++i) points[i - first] = table.knot(i);
    return lineshaft::knot_of({points.data(), last - first + 1}, at - first);
}

/// What a row is that is no spline.
PathFault curve_of(const PathTablePoint& row, const PathVector& from, PathCurve& out) {
    const PathVector to = row.target();
    if (row.kind != PathPointKind::arc) return line_to(from, to, out, path_space);
    const PathFault fault = arc_through(in_space(from), row.auxiliary(), in_space(to), out);
    if (fault == PathFault::none) let_follow(out, from, to);
    return fault;
}

/// How row k, a spline of degree five, passes its own point.
PathPoint passage(const PathRows& table, std::size_t k, const PathVector& from) {
    const PathVector at = table.rows[k].target(), here = difference(at, from);
    const PathPoint alone = waypoint(from, at, at);
    if (k + 1 == table.rows.size()) return alone;
    PathCurve behind;
    PathPoint begin;
    if (is(PathPointKind::cubic, table, k + 1)) {
        begin = knot_of(table, k + 1, false).point();
    } else if (!is(PathPointKind::spline, table, k + 1) &&
               curve_of(table.rows[k + 1], at, behind) == PathFault::none) {
        begin = behind.at(0);
    } else {
        const PathVector next = table.rows[k + 1].target();
        return goes_on(here, difference(next, at)) ? waypoint(from, at, next) : alone;
    }
    return goes_on(here, begin.tangent) ? begin : alone;
}

}  // namespace

PathFault curves_of(const PathRows& table, std::size_t k, const PathVector& from,
                    const PathCurve* before, PathRowCurves& out, std::size_t& count) {
    count = 1;
    if (is(PathPointKind::cubic, table, k)) {
        PathKnot begin = knot_of(table, k, false);
        begin.position = from;
        count = cubic_between(begin, knot_of(table, k, true), out);
        return count > 0 ? PathFault::none : PathFault::not_finite;
    }
    if (!is(PathPointKind::spline, table, k)) return curve_of(table.rows[k], from, out[0]);
    PathPoint begin = waypoint(from, from, table.rows[k].target());
    if (before) {
        const PathPoint end = before->at(before->length);
        if (goes_on(end.tangent, begin.tangent)) begin = end;
    }
    count = spline_between(begin, passage(table, k, from), out);
    return count > 0 ? PathFault::none : PathFault::not_finite;
}

PathVector PathTablePoint::target() const {
    return {position[0], position[1], position[2], rotary[0], rotary[1], rotary[2]};
}

PathVector PathTablePoint::auxiliary() const {
    return {border[0], border[1], border[2]};
}

std::span<const Field> PathTable::fields() {
    static const Field fields[] = {
        parameter("unit", &PathTable::unit, "", "of the first three axes, as the group's")
            .one_of(axis_unit_names),
    };
    return fields;
}

std::span<const TableField> PathTable::tables() {
    static const Field columns[] = {
        real_column("position1", "{unit}", "of the first axis"),
        real_column("position2", "{unit}", "of the second"),
        real_column("position3", "{unit}", "of the third"),
        name_column("curve", path_point_kind_names,
                    "from the point before; a spline is of degree five, a cubic one natural"),
        real_column("border1", "{unit}", "of an arc: a point that it passes"),
        real_column("border2", "{unit}", "likewise"),
        real_column("border3", "{unit}", "likewise"),
        real_column("position4", "deg", "of the first rotary axis"),
        real_column("position5", "deg", "of the second"),
        real_column("position6", "deg", "of the third"),
    };
    static const TableField all[] = {[] {
        TableField points = lineshaft::table("points", &PathTable::table, columns,
                                             "the path, point by point, or a CSV file whose first "
                                             "line names these columns, position1 at least; a "
                                             "longer path is two tables, the second with an "
                                             "MC_MovePath of BufferMode mcBlendingLow");
        points.needed = 2;
        points.complete = [](std::byte* block) {
            return std::launder(reinterpret_cast<PathTable*>(block))->complete();
        };
        points.outline = [](const std::byte* block) {
            return std::launder(reinterpret_cast<const PathTable*>(block))->outline();
        };
        return points;
    }()};
    return all;
}

std::vector<std::array<double, 2>> PathTable::outline() const {
    constexpr int chords = 64;
    std::vector<std::array<double, 2>> line;
    if (table.size == 0) return line;
    const auto points = static_cast<std::size_t>(table.size);
    const PathRows behind{{table.rows.data() + 1, points - 1}, table.rows[0].target()};
    PathVector from = behind.start;
    line.push_back({from[0], from[1]});
    PathRowCurves curves;
    PathCurve last;
    const PathCurve* before = nullptr;
    for (std::size_t i = 0; i < behind.rows.size(); ++i) {
        std::size_t count = 0;
        if (curves_of(behind, i, from, before, curves, count) != PathFault::none) continue;
        for (std::size_t k = 0; k < count; ++k) {
            const int parts = curves[k].kind == PathCurveKind::line ? 1 : chords;
            for (int part = 1; part <= parts; ++part) {
                const PathVector x = curves[k].at(curves[k].length * part / parts).position;
                line.push_back({x[0], x[1]});
            }
        }
        last = curves[count - 1];
        before = &last;
        from = last.end;
    }
    return line;
}

std::optional<TableFault> PathTable::complete() {
    for (std::size_t i = 0; i < static_cast<std::size_t>(table.size); ++i) {
        const PathTablePoint& p = table.rows[i];
        for (const double x : p.target())
            if (!all_finite(x)) return TableFault{i, "a number is missing or infinite", ""};
        for (const double x : p.auxiliary())
            if (!all_finite(x)) return TableFault{i, "a number is missing or infinite", ""};
    }
    return {};
}

}  // namespace lineshaft

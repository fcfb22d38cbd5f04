#include "blocks/group/path_table.hpp"

#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

/// A row of rotary axes alone is a line.
bool is_spline(const PathTablePoint& row, const PathVector& from) {
    return row.kind == PathPointKind::spline && in_space(row.target()) != in_space(from);
}

/// Of a row that is no spline.
PathFault curve_of(const PathTablePoint& row, const PathVector& from, PathCurve& out) {
    const PathVector to = row.target();
    if (row.kind != PathPointKind::arc) return line_to(from, to, out, path_space);
    const PathFault fault = arc_through(in_space(from), row.auxiliary(), in_space(to), out);
    if (fault == PathFault::none) let_follow(out, from, to);
    return fault;
}

PathVector difference(const PathVector& a, const PathVector& b) {
    PathVector out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] - b[i];
    return out;
}

/// Neither turns back nor stands.
bool goes_on(const PathVector& a, const PathVector& b) {
    return in_space(a) != PathVector{} && in_space(b) != PathVector{} && !turns_back(a, b);
}

PathPoint passage(const PathTablePoint& row, const PathTablePoint* next, const PathVector& from) {
    const PathVector at = row.target(), way = difference(at, from);
    const PathPoint alone = waypoint(from, at, at);
    if (next == nullptr) return alone;
    PathCurve behind;
    if (is_spline(*next, at) || curve_of(*next, at, behind) != PathFault::none)
        return goes_on(way, difference(next->target(), at)) ? waypoint(from, at, next->target())
                                                            : alone;
    const PathPoint begin = behind.at(0);
    return goes_on(way, begin.tangent) ? begin : alone;
}

}  // namespace

PathFault curves_of(const PathTablePoint& row, const PathTablePoint* next, const PathVector& from,
                    const PathCurve* before, PathRowCurves& out, std::size_t& count) {
    count = 1;
    if (!is_spline(row, from)) return curve_of(row, from, out[0]);
    PathPoint begin = waypoint(from, from, row.target());
    if (before) {
        const PathPoint end = before->at(before->length);
        if (goes_on(end.tangent, begin.tangent)) begin = end;
    }
    count = spline_between(begin, passage(row, next, from), out);
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
        name_column("curve", path_point_kind_names, "from the point before"),
        real_column("border1", "{unit}", "of an arc: a point that it passes"),
        real_column("border2", "{unit}", "likewise"),
        real_column("border3", "{unit}", "likewise"),
        real_column("position4", "deg", "of the first rotary axis"),
        real_column("position5", "deg", "of the second"),
        real_column("position6", "deg", "of the third"),
    };
    static const TableField all[] = {[] {
        TableField points = lineshaft::table("points", &PathTable::table, columns,
                                             "the path, point by point, or a CSV file");
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
    PathVector from = table.rows[0].target();
    line.push_back({from[0], from[1]});
    PathRowCurves curves;
    PathCurve last;
    const PathCurve* before = nullptr;
    for (std::size_t i = 1; i < static_cast<std::size_t>(table.size); ++i) {
        const PathTablePoint* const next =
            i + 1 < static_cast<std::size_t>(table.size) ? &table.rows[i + 1] : nullptr;
        std::size_t count = 0;
        if (curves_of(table.rows[i], next, from, before, curves, count) != PathFault::none)
            continue;
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

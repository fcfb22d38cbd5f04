#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "blocks/axis/axis_unit.hpp"
#include "blocks/path/path_spline.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

inline constexpr std::size_t most_path_points = 1024;

/// How a point of a path_table is reached from the one before.
enum class PathPointKind : std::int64_t { line, arc, spline, cubic };

inline constexpr std::string_view path_point_kind_names[] = {"line", "arc", "spline", "cubic"};

/// A row: the position of the first three axes, how it is reached, of an arc a point that it
/// passes, and the position of the rotary axes.
struct PathTablePoint {
    std::array<double, path_space> position{};
    PathPointKind kind = PathPointKind::line;
    std::array<double, path_space> border{};
    std::array<double, most_path_axes - path_space> rotary{};

    PathVector target() const;
    PathVector auxiliary() const;
};

using PathRowCurves = std::array<PathCurve, most_spline_parts>;

/// Rows of a table, and the point from which the first of them begins.
struct PathRows {
    std::span<const PathTablePoint> rows;
    PathVector start{};

    /// Where row k begins, and where the last one ends.
    PathVector knot(std::size_t k) const { return k == 0 ? start : rows[k - 1].target(); }
};

/// The curves of row k from the point `from`: one, or the parts of a spline. A row of a cubic
/// spline is a part of the one through all such rows that follow each other. One of degree five
/// begins as the curve `before` ends, if there is one, and passes its own point as the line, arc or
/// cubic spline of the next row begins, else along the circle through the points before and behind.
/// Where the way turns back a spline ends and begins along its own chord: a stop.
PathFault curves_of(const PathRows& table, std::size_t k, const PathVector& from,
                    const PathCurve* before, PathRowCurves& out, std::size_t& count);

/// The points of a path for MC_MovePath, in the program or in a CSV file.
struct PathTable {
    struct Points {
        std::int64_t size = 0;
        std::array<PathTablePoint, most_path_points> rows{};
    };

    AxisUnit unit = AxisUnit::mm;
    Points table;

    static constexpr std::string_view type = "path_table";
    static constexpr std::string_view doc = "points of a path, by lines, arcs and splines";
    static constexpr std::string_view handle = "PATH_REF";
    static std::span<const Field> fields();
    static std::span<const TableField> tables();
    void scan(const Scan&) {}

    /// A number that is missing or infinite.
    std::optional<TableFault> complete();

    /// In the plane of the first two axes, from the first row's point on; curves as 64 chords each.
    std::vector<std::array<double, 2>> outline() const;
};

}  // namespace lineshaft

#include "blocks/axis/cam_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace lineshaft {

std::string seam_of(const Cam& cam) {
    if (!(cam.length() > 0)) return {};  // no cam, which was told
    const double first = cam.at(cam.begin()).slope, last = cam.last().slope;
    if (std::abs(last - first) <= rounding_of_cams * cam.extremes().slope) return {};
    return fmt::format(
        "ends with a slope of {:.6g} and begins with {:.6g}: the slave's velocity jumps there. "
        "Give both ends the same velocity; a periodic table does where they are left open",
        last, first);
}

std::optional<Misfit> CamTable::doubt(const InstanceAt&) const {
    if (!periodic || table.size == 0) return {};
    const std::string why = seam_of(cam(true));
    return why.empty() ? std::nullopt : std::optional(Misfit{"periodic", why});
}

std::span<const Field> CamTable::fields() {
    static const Field fields[] = {
        parameter("unit", &CamTable::unit, "",
                  "of the slave; of a profile over time: of the axis, its velocity or acceleration")
            .one_of(cam_unit_names),
        parameter("master_unit", &CamTable::master_unit, "",
                  "of the master; s: a profile over time")
            .one_of(cam_unit_names),
        parameter("periodic", &CamTable::periodic, "",
                  "open velocities go on from the end to the beginning"),
    };
    return fields;
}

std::span<const TableField> CamTable::tables() {
    static const Field columns[] = {
        real_column("master", "{master_unit}", "position of the master; rises from row to row"),
        real_column("slave", "{unit}", "position of the slave"),
        real_column("velocity", "{unit}/{master_unit}", "slave per master; else of a spline"),
        real_column("acceleration", "{unit}/{master_unit}^2", "likewise"),
        name_column("curve", cam_curve_names, "to the next point"),
    };
    static const TableField all[] = {[] {
        TableField points = lineshaft::table("points", &CamTable::table, columns,
                                             "the cam, point by point, or a CSV file; [0 mm, 0 mm, "
                                             "~, ~, cubic] leaves two columns open");
        points.needed = 2;
        points.complete = [](std::byte* block) {
            return std::launder(reinterpret_cast<CamTable*>(block))->complete();
        };
        return points;
    }()};
    return all;
}

std::optional<TableFault> CamTable::complete() {
    const std::span<CamPoint> points(table.rows.data(), static_cast<std::size_t>(table.size));
    const CamProblem problem = complete_cam(points, periodic);
    switch (problem.fault) {
        case CamFault::none:
            return {};
        case CamFault::too_few_points:
            return TableFault{problem.point, "a cam has two points at least", ""};
        case CamFault::not_finite:
            return TableFault{problem.point, "a number is missing or infinite", ""};
        case CamFault::not_monotonic:
            break;
    }
    return TableFault{problem.point, "the master does not rise from the point before",
                      "put the points in the order of the master, each once"};
}

}  // namespace lineshaft

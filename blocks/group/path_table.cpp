#include "blocks/group/path_table.hpp"

#include "blocks/inputs.hpp"

namespace lineshaft {

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
        return points;
    }()};
    return all;
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

#include "blocks/motion/cam_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "blocks/motion/cam_table_select.hpp"

namespace lineshaft {

namespace {

constexpr double rounding_of_cams = 1e-9;  ///< of a slope, of a period

template <class Block>
const Block& block_at(const InstanceAt& at, std::int64_t number) {
    return *std::launder(reinterpret_cast<const Block*>(at(number)));
}

/// With the slave's position it goes on from the end by `lift`: on a modulo axis whole turns lead
/// back to the beginning.
bool leads_back(const Cam& cam, const Axis& slave) {
    const double turns = slave.modulo ? cam.lift() / slave.period : 0;
    const double off = slave.modulo ? turns - std::round(turns) : cam.lift();
    const double whole = slave.modulo ? std::max(1.0, std::abs(turns)) : cam.extremes().y;
    return std::abs(off) <= rounding_of_cams * whole;
}

}  // namespace

std::string seam_of(const Cam& cam) {
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
                  "of the slave; of a profile over time: of the axis, or its velocity")
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
                                             "the cam, point by point, or a CSV file");
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

std::span<const Field> CamTableSelect::fields() {
    using S = CamTableSelect;
    static const Field fields[] = {
        in_out("Master", &S::master, Axis::type, "that the cam is for"),
        in_out("Slave", &S::slave, Axis::type, "that the cam is for"),
        in_out("CamTable", &S::cam_table, CamTable::type, "that is selected"),
        input("Execute", &S::execute, "", "rising edge: selects"),
        input("Periodic", &S::periodic, "", "the cam begins anew at its end"),
        input("MasterAbsolute", &S::master_absolute, "",
              "the cam is of the master's position, else of its way from MC_CamIn on"),
        input("SlaveAbsolute", &S::slave_absolute, "",
              "the cam gives the slave's position, else its way"),
        output("Done", &S::done, "", "CamTableID can be used"),
        output("Busy", &S::busy, "", "never: a cam is selected at once"),
        output("Error", &S::error, "", "there is nothing to select"),
        output("ErrorID", &S::error_id, "", "why").one_of(motion_error_names),
        output("CamTableID", &S::id, "", "for MC_CamIn"),
    };
    return fields;
}

std::optional<Misfit> CamTableSelect::doubt(const InstanceAt& at) const {
    if (!periodic || cam_table == nowhere || slave == nowhere) return {};
    const auto& table = block_at<CamTable>(at, cam_table);
    if (table.table.size == 0) return {};
    const Cam cam = table.cam(true);
    if (slave_absolute && !leads_back(cam, block_at<Axis>(at, slave)))
        return Misfit{"Periodic",
                      fmt::format("begins a cam anew that ends {:.6g} further than it begins: the "
                                  "slave goes on by that each period, though SlaveAbsolute says "
                                  "that the cam gives its position. Close the cam, or write "
                                  "SlaveAbsolute: false",
                                  cam.lift())};
    const std::string why = table.periodic ? "" : seam_of(cam);
    if (why.empty()) return {};
    return Misfit{"Periodic", "begins a cam anew that " + why};
}

void CamTableSelect::scan(const Scan&, const Context& context) {
    if (rising_edge(execute, last_execute)) {
        const bool found =
            cam_table != nowhere && context.instance<CamTable>(cam_table).table.size > 0;
        id = found ? CamTableId{cam_table, periodic, master_absolute, slave_absolute}.number() : 0;
        error_id = found ? MotionError::none : MotionError::no_cam;
    }
    error = execute && error_id != MotionError::none;
    done = execute && !error;
}

}  // namespace lineshaft

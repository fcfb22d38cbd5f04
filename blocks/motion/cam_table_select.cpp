#include "blocks/motion/cam_table_select.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace lineshaft {

namespace {

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
        input("ExecutionMode", &S::mode, "",
              "makes no difference: to select a cam changes nothing that is at work")
            .one_of(execution_mode_names),
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

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "blocks/axis/axis_unit.hpp"
#include "blocks/profile/cam.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// The points of a cam: data that MC_CamTableSelect names. Given in the program or in a CSV file,
/// and checked and completed when it is loaded: a scan does nothing.
struct CamTable {
    struct Points {
        std::int64_t size = 0;
        std::array<CamPoint, most_cam_points> rows{};
    };

    AxisUnit unit = AxisUnit::mm, master_unit = AxisUnit::mm;
    bool periodic = false;
    Points table;

    static constexpr std::string_view type = "cam_table";
    static constexpr std::string_view doc = "points of a cam, slave over master";
    static constexpr std::string_view handle = "CAM_REF";
    static std::span<const Field> fields();
    static std::span<const TableField> tables();
    void scan(const Scan&) {}

    /// Puts in what the points leave open.
    std::optional<TableFault> complete();

    Cam cam(bool repeats) const {
        return {{table.rows.data(), static_cast<std::size_t>(table.size)}, repeats};
    }
};

/// What MC_CamTableSelect has selected, in one number: 0 is nothing.
struct CamTableId {
    std::int64_t table = -1;  ///< number of the instance
    bool periodic = false, master_absolute = true, slave_absolute = true;

    std::int64_t number() const {
        return (table + 1) * 8 + (periodic ? 1 : 0) + (master_absolute ? 2 : 0) +
               (slave_absolute ? 4 : 0);
    }
    static CamTableId of(std::int64_t number) {
        return {number / 8 - 1, (number & 1) != 0, (number & 2) != 0, (number & 4) != 0};
    }
};

}  // namespace lineshaft

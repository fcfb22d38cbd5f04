#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "blocks/axis/axis_unit.hpp"
#include "blocks/axis/profile_motion.hpp"
#include "blocks/profile/cam.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// A cam has those of axes, of their velocities and accelerations, and time. Each as AxisUnit is.
enum class CamUnit : std::int64_t {
    mm,
    rad,
    deg,
    m,
    rev,
    mm_s,
    rad_s,
    deg_s,
    m_s,
    rev_s,
    mm_s2,
    rad_s2,
    deg_s2,
    m_s2,
    rev_s2,
    s,
};

inline constexpr std::string_view cam_unit_names[] = {
    "mm",  "rad",   "deg",    "m",       "rev",     "mm/s",  "rad/s",   "deg/s",
    "m/s", "rev/s", "mm/s^2", "rad/s^2", "deg/s^2", "m/s^2", "rev/s^2", "s"};

/// The points of a cam: data that MC_CamTableSelect names. Given in the program or in a CSV file,
/// and checked and completed when it is loaded: a scan does nothing.
struct CamTable {
    struct Points {
        std::int64_t size = 0;
        std::array<CamPoint, most_cam_points> rows{};
    };

    CamUnit unit = CamUnit::mm, master_unit = CamUnit::mm;
    bool periodic = false;
    Points table;

    static constexpr std::string_view type = "cam_table";
    static constexpr std::string_view doc = "points of a cam, slave over master";
    static constexpr std::string_view handle = "CAM_REF";
    static std::span<const Field> fields();
    static std::span<const TableField> tables();
    void scan(const Scan&) {}

    /// For MC_PositionProfile and so on of an axis.
    bool is_over_time(AxisUnit of_axis, ProfileOf of) const {
        constexpr auto row = static_cast<std::int64_t>(CamUnit::mm_s);
        return master_unit == CamUnit::s &&
               static_cast<std::int64_t>(unit) ==
                   static_cast<std::int64_t>(of_axis) + row * static_cast<std::int64_t>(of);
    }

    /// A periodic cam whose velocity jumps from its end to its beginning.
    std::optional<Misfit> doubt(const InstanceAt&) const;

    /// Puts in what the points leave open.
    std::optional<TableFault> complete();

    Cam cam(bool repeats) const {
        return {{table.rows.data(), static_cast<std::size_t>(table.size)}, repeats};
    }
};

/// Slopes and ends of cams are equal within this part of the greatest.
inline constexpr double rounding_of_cams = 1e-9;

/// Why the velocity of a slave jumps where the cam begins anew; empty where it does not.
std::string seam_of(const Cam& cam);

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

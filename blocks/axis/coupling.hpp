#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include "blocks/profile/curve.hpp"

namespace lineshaft {

/// Which position of its master a slave follows.
enum class MasterValueSource : std::int64_t { set_value, actual_value };

inline constexpr std::string_view master_value_source_names[] = {"mcSetValue", "mcActualValue"};

/// What becomes of two masters.
enum class CombineMode : std::int64_t { add, subtract };

inline constexpr std::string_view combine_mode_names[] = {"mcAddAxes", "mcSubAxes"};

/// Where the positions of a cam count from.
enum class StartMode : std::int64_t {
    absolute,
    relative,  ///< from where the slave is
    ramp_in,   ///< absolute; the slave gets onto the cam at once, within its limits
    direct,    ///< the slave is on the cam at once: it jumps where it was elsewhere
};

inline constexpr std::string_view start_mode_names[] = {"mcAbsolute", "mcRelative", "mcRampIn",
                                                        "mcDirect"};

/// One master with its gear.
struct MasterLink {
    std::int64_t axis = -1;  ///< number of the instance; below 0: none
    MasterValueSource source = MasterValueSource::set_value;
    double numerator = 1, denominator = 1;  ///< slave / master; the denominator is not 0

    double ratio() const { return numerator / denominator; }
    bool operator==(const MasterLink&) const = default;
};

/// What a command of synchronous motion asks besides its dynamics. [m] is the master's unit.
struct Coupling {
    MasterLink master, second;
    CombineMode combine = CombineMode::add;
    TransitionMode transition = TransitionMode::jerk_limited;
    std::int64_t catch_up = 0;  ///< not 0: also the position that the transition loses
    SyncMode sync_mode = SyncMode::shortest;
    double master_sync = 0;     ///< position of the master in sync [m]; of a cam: on its axis
    double slave_sync = 0;      ///< position of the slave in sync [u]
    double start_distance = 0;  ///< of the master before that, where the slave begins [m], >= 0
    std::int64_t cam = 0;       ///< CamTableID
    StartMode start_mode = StartMode::absolute;
    std::int64_t stays = 0;  ///< not 0: behind the ends of a cam that is not periodic, too
    std::int64_t falls = 0;  ///< not 0: a periodic cam begins anew where it began, not at its end
    double master_offset = 0, master_scaling = 1;  ///< cam's x = scaling * master + offset
    double slave_offset = 0, slave_scaling = 1;    ///< slave = scaling * cam(x) + offset

    bool operator==(const Coupling&) const = default;

    bool is_measured() const {
        return master.source == MasterValueSource::actual_value ||
               second.source == MasterValueSource::actual_value;
    }

    bool is_finite() const {
        for (const double x : {master.numerator, master.denominator, second.numerator,
                               second.denominator, master_sync, slave_sync, start_distance,
                               master_offset, master_scaling, slave_offset, slave_scaling})
            if (!std::isfinite(x)) return false;
        return true;
    }
};

}  // namespace lineshaft

#pragma once

#include "blocks/axis/axis.hpp"
#include "blocks/axis/cam_table.hpp"

namespace lineshaft {

/// MC_CamTableSelect (4.2): a cam table with the way it is to be read, in one number for MC_CamIn.
struct CamTableSelect {
    std::int64_t master = nowhere, slave = nowhere, cam_table = nowhere;
    bool execute = false, periodic = false, master_absolute = true, slave_absolute = true;
    BufferMode mode = BufferMode::aborting;
    bool done = false, busy = false, error = false;
    MotionError error_id = MotionError::none;
    std::int64_t id = 0;
    bool last_execute = false;

    static constexpr std::string_view type = "MC_CamTableSelect";
    static constexpr std::string_view doc = "selects a cam table";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
    /// A cam that begins anew without leading on from its end.
    std::optional<Misfit> doubt(const InstanceAt& at) const;
};

}  // namespace lineshaft

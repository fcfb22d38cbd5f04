#pragma once

#include <array>

#include "blocks/motion/command.hpp"
#include "blocks/motion/seen_motion.hpp"
#include "blocks/motion/switched_cam.hpp"

namespace lineshaft {

/// MC_DigitalCamSwitch (3.32): outputs that an axis switches as it moves past cams. Output1 and so
/// on show the state at the last scan of the axis that has been seen; OnTime1 and OffTime1 say when
/// it came, between two scans: also of a pulse that is over before the scan. The axis' way between
/// scans is a straight line; so a block in the task of its axis, behind it in the file, knows most.
/// A track is on while one of its cams is.
///
/// TrackOptions of the standard stand with the cams, in `Switches`; Outputs are those of the block.
struct DigitalCamSwitch {
    static constexpr std::size_t tracks = most_switch_tracks;

    std::int64_t axis = nowhere, switches = nowhere;
    bool enable = false;
    std::int64_t enable_mask = 0xFFFFFFFF;
    MasterValueSource source = MasterValueSource::actual_value;

    bool in_operation = false, busy = false, error = false;
    MotionError error_id = MotionError::none;
    std::array<bool, tracks> outputs{};
    std::array<std::int64_t, tracks> on_times{}, off_times{};  ///< [ns]

    SeenMotion motion;
    std::array<SwitchedCam, most_switch_cams> cams;
    bool knows_cams = false;  ///< their states are of the motion that has been seen

    static constexpr std::string_view type = "MC_DigitalCamSwitch";
    static constexpr std::string_view doc = "switches outputs as an axis moves past cams";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
    void shift(std::int64_t by);

  private:
    MotionError check(const Context& context) const;
    void stop(std::int64_t now);
    void pass(std::int64_t number, const CamSwitches& table, const Stretch* way, std::int64_t now);
    void show(std::size_t track, bool on, std::int64_t time);
};

}  // namespace lineshaft

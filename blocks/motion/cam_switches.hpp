#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "blocks/axis/axis_unit.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// A cam of MC_DigitalCamSwitch (CamSwitchMode 0 and 1).
enum class SwitchMode : std::int64_t {
    position,  ///< on from its first position to its last
    time,      ///< on for a time from its first position on
};

/// In which direction a cam counts.
enum class SwitchDirection : std::int64_t { both, positive, negative };

/// A cam on a track. One whose last position lies below its first goes over the end of a modulo
/// axis; on another axis it is on outside of both.
struct SwitchCam {
    std::int64_t track = 1;  ///< counts from 1
    double first = 0, last = 0;
    SwitchDirection direction = SwitchDirection::both;
    SwitchMode mode = SwitchMode::position;
    double duration = 0;  ///< [s]
};

/// What the cams of a track have in common. Compensations move the edges by the velocity, by so
/// much as the axis goes meanwhile: 0 changes nothing, below 0 is earlier.
struct SwitchTrack {
    double on_compensation = 0, off_compensation = 0;  ///< [s]
    double hysteresis = 0;  ///< so far goes an axis from an edge before that may switch again [u]
};

inline constexpr std::int64_t most_switch_tracks = 8, most_switch_cams = 64;

/// What MC_DigitalCamSwitch switches: MC_CAMSWITCH_REF, and MC_TRACK_REF with it. A scan does
/// nothing.
struct CamSwitches {
    struct Cams {
        std::int64_t size = 0;
        std::array<SwitchCam, most_switch_cams> rows{};
    };
    struct Tracks {
        std::int64_t size = 0;
        std::array<SwitchTrack, most_switch_tracks> rows{};
    };

    AxisUnit unit = AxisUnit::mm;
    Cams cams;
    Tracks tracks;

    static constexpr std::string_view type = "cam_switches";
    static constexpr std::string_view doc = "cams and tracks of MC_DigitalCamSwitch";
    static constexpr std::string_view handle = "MC_CAMSWITCH_REF";
    static std::span<const Field> fields();
    static std::span<const TableField> tables();
    void scan(const Scan&) {}

    /// Without a row of its own a track has no compensation and no hysteresis.
    SwitchTrack track(std::int64_t number) const {
        return number <= tracks.size ? tracks.rows[static_cast<std::size_t>(number - 1)]
                                     : SwitchTrack{};
    }
};

}  // namespace lineshaft

#include "blocks/motion/cam_switches.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view mode_names[] = {"mcPosition", "mcTime"};
constexpr std::string_view direction_names[] = {"mcBoth", "mcPositive", "mcNegative"};

}  // namespace

std::span<const Field> CamSwitches::fields() {
    static const Field fields[] = {
        parameter("unit", &CamSwitches::unit, "", "of the axis").one_of(axis_unit_names),
    };
    return fields;
}

std::span<const TableField> CamSwitches::tables() {
    static const Field cam_columns[] = {
        column("track", "", "on which the cam is").at_least(1).at_most(most_switch_tracks),
        real_column("first", "{unit}", "position from which it is on; of a time cam: at which"),
        real_column("last", "{unit}", "position up to which it is on; not used by a time cam"),
        name_column("direction", direction_names, "of the axis, in which the cam counts"),
        name_column("mode", mode_names, "on between two positions, or for a time"),
        real_column("duration", "s", "of a time cam").at_least(0),
    };
    static const Field track_columns[] = {
        real_column("on_compensation", "s", "switches on so much later; below 0: earlier"),
        real_column("off_compensation", "s", "switches off so much later; below 0: earlier"),
        real_column("hysteresis", "{unit}",
                    "so far goes the axis from an edge before that may switch again")
            .at_least(0),
    };
    static const TableField all[] = {
        [] {
            TableField rows = lineshaft::table("switches", &CamSwitches::cams, cam_columns,
                                               "the cams, a row a cam, in any order");
            rows.needed = 3;
            return rows;
        }(),
        [] {
            TableField rows =
                lineshaft::table("tracks", &CamSwitches::tracks, track_columns,
                                 "the tracks from 1 on, a row a track; those left out have none");
            rows.needed = 1;
            return rows;
        }()};
    return all;
}

}  // namespace lineshaft

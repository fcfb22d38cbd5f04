#pragma once

#include "blocks/motion/command.hpp"

namespace lineshaft {

/// Commands by which a slave follows others, or a profile (PLCopen Part 1 v2.0, 4.3 to 4.10, 3.14
/// to 3.16). `axis` of the base is the slave. Quantities of the master are in its own unit.

/// MC_GearIn: on the way of ratio x master in the least time, within the slave's limits relative to
/// the master's motion. A change of the ratio is a new start. Beyond the standard: Transition says
/// what stays steady on the way, and CatchUp makes up the position that it loses, with Velocity.
struct GearIn : CommandBlock {
    bool catch_up = false;

    static constexpr std::string_view type = "MC_GearIn";
    static constexpr std::string_view doc = "gears a slave to its master";
    static std::span<const Field> fields();
    constexpr GearIn() { pins.command = Command::gear_in; }
    void scan(const Scan& now, const Context& context);
};

/// MC_GearInPos: at MasterSyncPosition the slave is at SlaveSyncPosition, with ratio x the master's
/// velocity. It leaves for it MasterStartDistance before, or at once where that is 0. Error if it
/// cannot come there within its limits.
struct GearInPos : CommandBlock {
    bool start_sync = false;

    static constexpr std::string_view type = "MC_GearInPos";
    static constexpr std::string_view doc = "gears a slave to its master from a position on";
    static std::span<const Field> fields();
    constexpr GearInPos() { pins.command = Command::gear_in_pos; }
    void scan(const Scan& now, const Context& context);
};

/// MC_CamIn: as MC_GearInPos, onto a cam. MasterSyncPosition is a position on the cam. A cam that
/// is not periodic is executed once.
struct CamIn : CommandBlock {
    bool stays_coupled = false, appends = true;
    bool start_sync = false, end_of_profile = false;
    double ends = 0;  ///< of the profile, that have been shown

    static constexpr std::string_view type = "MC_CamIn";
    static constexpr std::string_view doc = "couples a slave to its master by a cam";
    static std::span<const Field> fields();
    constexpr CamIn() { pins.command = Command::cam_in; }
    void scan(const Scan& now, const Context& context);
};

/// MC_PhasingAbsolute, MC_PhasingRelative: shift the master as the slave sees it; a shift above 0
/// lets the slave lead.
struct Phasing : CommandBlock {
    double shift = 0, covered_shift = 0;

    void scan(const Scan& now, const Context& context);
};

struct PhasingAbsolute : Phasing {
    static constexpr std::string_view type = "MC_PhasingAbsolute";
    static constexpr std::string_view doc = "shifts the master that a slave sees to a value";
    static std::span<const Field> fields();
    constexpr PhasingAbsolute() { pins.command = Command::phasing_absolute; }
};

struct PhasingRelative : Phasing {
    static constexpr std::string_view type = "MC_PhasingRelative";
    static constexpr std::string_view doc = "shifts the master that a slave sees by a value";
    static std::span<const Field> fields();
    constexpr PhasingRelative() { pins.command = Command::phasing_relative; }
};

/// MC_PositionProfile, -Velocity-, -AccelerationProfile (3.14 to 3.16): the motion that a cam_table
/// gives over time (master_unit: s), within the limits of the axis. It begins where the axis is,
/// with its velocity.
struct Profile : CommandBlock {
    std::int64_t table = nowhere;

    void scan(const Scan& now, const Context& context);
};

/// Positions; the profile ends in rest.
struct PositionProfile : Profile {
    static constexpr std::string_view type = "MC_PositionProfile";
    static constexpr std::string_view doc = "moves an axis by positions over time";
    static std::span<const Field> fields();
    constexpr PositionProfile() { pins.command = Command::position_profile; }
};

/// Velocities; the last one is kept.
struct VelocityProfile : Profile {
    static constexpr std::string_view type = "MC_VelocityProfile";
    static constexpr std::string_view doc = "moves an axis by velocities over time";
    static std::span<const Field> fields();
    constexpr VelocityProfile() { pins.command = Command::velocity_profile; }
};

/// Accelerations; they end with 0, and the velocity that they have led to is kept.
struct AccelerationProfile : Profile {
    static constexpr std::string_view type = "MC_AccelerationProfile";
    static constexpr std::string_view doc = "moves an axis by accelerations over time";
    static std::span<const Field> fields();
    constexpr AccelerationProfile() { pins.command = Command::acceleration_profile; }
};

namespace command_kinds {

std::span<const Field> gear_out_fields();
std::span<const Field> combine_fields();

inline constexpr CommandKind gear_out{Command::gear_out, "MC_GearOut",
                                      "leaves a gear: the slave keeps its velocity",
                                      gear_out_fields};
inline constexpr CommandKind cam_out{Command::cam_out, "MC_CamOut",
                                     "leaves a cam: the slave keeps its velocity", gear_out_fields};
inline constexpr CommandKind combine_axes{Command::combine_axes, "MC_CombineAxes",
                                          "gears a slave to the sum or difference of two masters",
                                          combine_fields};

}  // namespace command_kinds

using GearOut = PlainCommand<command_kinds::gear_out>;
using CamOut = PlainCommand<command_kinds::cam_out>;
using CombineAxes = PlainCommand<command_kinds::combine_axes>;

}  // namespace lineshaft

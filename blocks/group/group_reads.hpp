#pragma once

#include "blocks/group/axes_group.hpp"

namespace lineshaft {

/// What blocks with an Enable have in common that look at a group as wires see it.
struct GroupReadBlock {
    std::int64_t group = nowhere;
    bool enable = false;
    bool valid = false, busy = false, error = false;
    MotionError error_id = MotionError::none;

    /// The group while Enable is true; null, and Valid false, else. Without a group an error.
    const AxesGroup* look(const Context& context);
};

/// MC_GroupReadStatus: the state of a group, one output each, and how it moves along its path.
struct GroupReadStatus : GroupReadBlock {
    bool states[group_state_count] = {};
    bool constant_velocity = false, accelerating = false, decelerating = false, in_position = false;

    static constexpr std::string_view type = "MC_GroupReadStatus";
    static constexpr std::string_view doc = "tells the state of a group";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_GroupReadError.
struct GroupReadError : GroupReadBlock {
    MotionError group_error = MotionError::none;

    static constexpr std::string_view type = "MC_GroupReadError";
    static constexpr std::string_view doc = "tells the error of a group";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// A number for each axis.
struct GroupReadVector : GroupReadBlock {
    CoordSystem coordinates = CoordSystem::machine;
    PathVector value{};
};

/// MC_GroupReadActualPosition: of the drives where the axes have some.
struct GroupReadActualPosition : GroupReadVector {
    static constexpr std::string_view type = "MC_GroupReadActualPosition";
    static constexpr std::string_view doc = "tells where the axes of a group are";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_GroupReadSetPosition, beyond the standard: set-points, as SMC_GroupReadSetPosition of
/// SoftMotion has them.
struct GroupReadSetPosition : GroupReadVector {
    static constexpr std::string_view type = "MC_GroupReadSetPosition";
    static constexpr std::string_view doc = "tells where the axes of a group are to be";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_GroupReadActualVelocity: of the drives where the axes have some.
struct GroupReadActualVelocity : GroupReadVector {
    static constexpr std::string_view type = "MC_GroupReadActualVelocity";
    static constexpr std::string_view doc = "tells how fast the axes of a group are";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

}  // namespace lineshaft

#pragma once

#include "blocks/motion/command.hpp"

namespace lineshaft {

/// What blocks with an Enable have in common that look at an axis as wires see it.
struct ReadBlock {
    std::int64_t axis = nowhere;
    bool enable = false;
    bool valid = false, busy = false, error = false;
    MotionError error_id = MotionError::none;

    /// The axis while Enable is true; null, and Valid false, else. Without an axis an error.
    const Axis* look(const Context& context);
};

/// Axis, Enable, the outputs of all, and a block's own fields.
std::vector<Field> read_table(std::initializer_list<Field> own);

/// MC_ReadStatus (3.19): the state of an axis, one output each.
struct ReadStatus : ReadBlock {
    bool states[axis_state_count] = {};

    static constexpr std::string_view type = "MC_ReadStatus";
    static constexpr std::string_view doc = "tells the state of an axis";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_ReadMotionState (3.20).
struct ReadMotionState : ReadBlock {
    bool constant_velocity = false, accelerating = false, decelerating = false;
    bool direction_positive = false, direction_negative = false;

    static constexpr std::string_view type = "MC_ReadMotionState";
    static constexpr std::string_view doc = "tells how the set-point of an axis moves";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_ReadAxisError (3.22).
struct ReadAxisError : ReadBlock {
    MotionError axis_error = MotionError::none;

    static constexpr std::string_view type = "MC_ReadAxisError";
    static constexpr std::string_view doc = "tells the error of an axis";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_ReadActualPosition, MC_ReadActualVelocity (3.16, 3.17): of the drive where the axis has one.
struct ReadActualPosition : ReadBlock {
    double position = 0;

    static constexpr std::string_view type = "MC_ReadActualPosition";
    static constexpr std::string_view doc = "tells where an axis is";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

struct ReadActualVelocity : ReadBlock {
    double velocity = 0;

    static constexpr std::string_view type = "MC_ReadActualVelocity";
    static constexpr std::string_view doc = "tells how fast an axis is";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_ReadParameter (3.14).
struct ReadParameter : ReadBlock {
    std::int64_t number = 1;
    double value = 0;

    static constexpr std::string_view type = "MC_ReadParameter";
    static constexpr std::string_view doc = "tells a parameter of an axis, by PLCopen's number";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

}  // namespace lineshaft

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

/// MC_ReadStatus (3.27): the state of an axis, one output each.
struct ReadStatus : ReadBlock {
    bool states[axis_state_count] = {};

    static constexpr std::string_view type = "MC_ReadStatus";
    static constexpr std::string_view doc = "tells the state of an axis";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_ReadMotionState (3.28). What is commanded and the set-point are one here: what the axis gives
/// out. Of a drive, which measures no acceleration, the speed is compared with the one that was
/// seen in the axis' scan before.
struct ReadMotionState : ReadBlock {
    enum class Source : std::int64_t { commanded_value, set_value, actual_value };
    Source source = Source::commanded_value;
    double last_velocity = 0, change = 0;  ///< as measured; from scan to scan
    std::int64_t last_time = 0;            ///< of the axis' scan [ns]
    bool has_looked = false;               ///< at a drive

    bool constant_velocity = false, accelerating = false, decelerating = false;
    bool direction_positive = false, direction_negative = false;

    static constexpr std::string_view type = "MC_ReadMotionState";
    static constexpr std::string_view doc = "tells how an axis moves";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
    void shift(std::int64_t by) { last_time += by; }

  private:
    void measure(const Axis& seen);
};

/// MC_ReadAxisInfo (3.29). An axis has no network and no switches here: its software limits stand
/// for the limit switches.
struct ReadAxisInfo : ReadBlock {
    bool home_abs_switch = false, limit_switch_positive = false, limit_switch_negative = false;
    bool simulation = false, communication_ready = false, ready_for_power_on = false;
    bool power_on = false, is_homed = false, axis_warning = false;

    static constexpr std::string_view type = "MC_ReadAxisInfo";
    static constexpr std::string_view doc = "tells what an axis has and whether it is ready";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_ReadAxisError (3.30).
struct ReadAxisError : ReadBlock {
    MotionError axis_error = MotionError::none;

    static constexpr std::string_view type = "MC_ReadAxisError";
    static constexpr std::string_view doc = "tells the error of an axis";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_ReadActualPosition, MC_ReadActualVelocity (3.24, 3.25): of the drive where the axis has one.
struct ReadActualPosition : ReadBlock {
    double position = 0;

    static constexpr std::string_view type = "MC_ReadActualPosition";
    static constexpr std::string_view doc = "tells where an axis is";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_ReadSetPosition, beyond the standard: the set-point, also where the axis has a drive.
struct ReadSetPosition : ReadBlock {
    double position = 0;

    static constexpr std::string_view type = "MC_ReadSetPosition";
    static constexpr std::string_view doc = "tells where an axis is to be";
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

/// MC_ReadParameter (3.19.1).
struct ReadParameter : ReadBlock {
    std::int64_t number = 1;
    double value = 0;

    static constexpr std::string_view type = "MC_ReadParameter";
    static constexpr std::string_view doc = "tells a parameter of an axis, by PLCopen's number";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_ReadBoolParameter (3.19.2).
struct ReadBoolParameter : ReadBlock {
    std::int64_t number = 4;
    bool value = false;

    static constexpr std::string_view type = "MC_ReadBoolParameter";
    static constexpr std::string_view doc =
        "tells whether a parameter of an axis is on, by PLCopen's number";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

}  // namespace lineshaft

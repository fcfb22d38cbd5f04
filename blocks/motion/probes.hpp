#pragma once

#include "blocks/motion/reads.hpp"

namespace lineshaft {

/// MC_TouchProbe (3.25): the actual position in the scan in which TriggerInput rises; with
/// WindowOnly only within FirstPosition..LastPosition. MC_AbortTrigger ends it.
struct TouchProbe {
    std::int64_t axis = nowhere;
    bool execute = false, trigger = false, window_only = false;
    double first_position = 0, last_position = 0;

    bool done = false, busy = false, command_aborted = false, error = false;
    MotionError error_id = MotionError::none;
    double recorded_position = 0;

    enum class Phase : std::int64_t { idle, armed, recorded, aborted, refused };
    Phase phase = Phase::idle;
    bool last_execute = false, last_trigger = false, told = false;
    std::int64_t aborts = 0;  ///< of the axis, when it was armed

    static constexpr std::string_view type = "MC_TouchProbe";
    static constexpr std::string_view doc = "records where an axis is when a signal comes";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);

  private:
    void look(const Axis& seen, bool rises);
    void show();
};

namespace command_kinds {

std::span<const Field> abort_trigger_fields();
inline constexpr CommandKind abort_trigger{Command::abort_trigger, "MC_AbortTrigger",
                                           "ends all MC_TouchProbe of an axis that wait",
                                           abort_trigger_fields};

}  // namespace command_kinds

using AbortTrigger = PlainCommand<command_kinds::abort_trigger>;

/// MC_DigitalCamSwitch (3.24), one track with one cam: Output is true from FirstOnPosition to
/// LastOnPosition; a cam whose last position is below the first goes over the end of a modulo axis.
/// Compensations shift the edges in time, by the velocity; negative ones switch early.
struct DigitalCamSwitch : ReadBlock {
    enum class Side : std::int64_t { both, positive, negative };
    Side side = Side::both;
    double first_on_position = 0, last_on_position = 0;
    double on_compensation = 0, off_compensation = 0;  ///< [s]
    bool is_on = false, last_on = false, last_off = false;

    static constexpr std::string_view type = "MC_DigitalCamSwitch";
    static constexpr std::string_view doc = "is true while an axis is within a window";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);

  private:
    void switch_output(const Axis& seen, bool knows_edges);
};

}  // namespace lineshaft

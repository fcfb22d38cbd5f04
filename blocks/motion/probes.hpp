#pragma once

#include "blocks/motion/command.hpp"
#include "blocks/motion/seen_motion.hpp"

namespace lineshaft {

/// MC_TouchProbe (3.33): where the axis is when TriggerInput rises, for the first time after
/// Execute; with WindowOnly the first time between FirstPosition and LastPosition, which belong to
/// it. MC_AbortTrigger ends it.
///
/// A signal is seen in a scan; when it has come in between says TriggerTime, as OnTime1 of
/// MC_DigitalCamSwitch or an input that takes its own time. The position is then the one at that
/// time, on a straight line between two scans of the axis. Without it, or with 0, it is the one of
/// the scan. A time that is more than 15 scans old, or to come, is refused.
struct TouchProbe {
    std::int64_t axis = nowhere;
    bool execute = false, trigger = false, window_only = false;
    std::int64_t trigger_time = 0;  ///< [ns]
    double first_position = 0, last_position = 0;

    bool done = false, busy = false, command_aborted = false, error = false;
    MotionError error_id = MotionError::none;
    double recorded_position = 0;
    std::int64_t recorded_time = 0;  ///< [ns]

    enum class Phase : std::int64_t { idle, armed, triggered, recorded, aborted, refused };
    Phase phase = Phase::idle;
    bool last_execute = false, last_trigger = false, told = false;
    std::int64_t aborts = 0;  ///< of the axis, when it was armed
    std::int64_t moment =
        0;  ///< of the trigger, of which the axis' scan has not been seen yet [ns]
    SeenMotion motion;

    static constexpr std::string_view type = "MC_TouchProbe";
    static constexpr std::string_view doc = "records where an axis is when a signal comes";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
    void shift(std::int64_t by);

  private:
    void arm(const Context& context);
    void look(const Axis& seen, bool rises, std::int64_t now);
    void take(std::int64_t now);
    void record();
    void show();
};

/// MC_AbortTrigger (3.34). A trigger is a signal here and has no name of its own: it ends all
/// probes of the axis.
namespace command_kinds {

std::span<const Field> abort_trigger_fields();
inline constexpr CommandKind abort_trigger{Command::abort_trigger, "MC_AbortTrigger",
                                           "ends all MC_TouchProbe of an axis that wait",
                                           abort_trigger_fields};

}  // namespace command_kinds

using AbortTrigger = PlainCommand<command_kinds::abort_trigger>;

}  // namespace lineshaft

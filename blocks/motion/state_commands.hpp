#pragma once

#include "blocks/motion/command.hpp"

namespace lineshaft {

/// MC_Power (3.1): sends the levels of its inputs in its first scan, and each change of them.
/// Without power an axis ramps down with its own dynamics. A command whose way goes in a direction
/// that is not enabled is refused; a motion that goes that way all the same, or while its direction
/// is taken away, brakes with the axis' own dynamics: ErrorStop. The standard leaves that open.
struct Power : CommandBlock {
    bool enable_positive = true, enable_negative = true;
    bool status = false;

    static constexpr std::string_view type = "MC_Power";
    static constexpr std::string_view doc = "switches the power of an axis on and off";
    static std::span<const Field> fields();
    void scan(const Scan& now, const Context& context);
};

/// MC_Stop (3.3): holds the axis in Stopping while Execute is true. Only MC_Power and an error of
/// the axis abort it: another MC_Stop is refused meanwhile, unless both have a Significance; the
/// same one, begun anew, goes on to hold the axis, and brakes with its new pins where it then
/// stands sooner.
struct Stop : CommandBlock {
    static constexpr std::string_view type = "MC_Stop";
    static constexpr std::string_view doc = "stops an axis, and holds it while Execute is true";
    static std::span<const Field> fields();
    constexpr Stop() { pins.command = Command::stop; }
    void scan(const Scan& now, const Context& context);
};

namespace command_kinds {

std::span<const Field> reset_fields();
inline constexpr CommandKind reset{Command::reset, "MC_Reset", "ends the error of an axis",
                                   reset_fields};

}  // namespace command_kinds

using Reset = PlainCommand<command_kinds::reset>;

}  // namespace lineshaft

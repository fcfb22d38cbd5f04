#pragma once

#include <cstdint>
#include <iterator>
#include <string_view>

namespace lineshaft {

/// By whose rules an axis carries out a command: PLCopen's, or those of a vendor whose library has
/// given it.
enum class CommandRules : std::int64_t { plcopen, twincat, softmotion };

inline constexpr std::string_view command_rules_names[] = {"plcopen", "twincat", "softmotion"};

/// What differs from vendor to vendor.
struct RulesOfVendor {
    bool one_waits = false;          ///< another one that would wait is refused
    bool ends_endless = false;       ///< what would wait for a motion without an end aborts it
    bool halts_where_due = false;    ///< a blended halt begins where the move before was to end
    bool reset_ends_stop = false;    ///< MC_Reset also ends what MC_Stop holds
    bool blends_moves_only = false;  ///< nothing is blended behind what does not end standing
    /// A buffered or blended absolute move ends further by all that has come on top since the last
    /// aborting command. PLCopen's ends at its Position.
    bool keeps_superimposed = false;
    bool leaves_groups = false;   ///< a command to an axis that its group moves takes it out
    bool exchanges_cams = false;  ///< of a cam at work another CamTableID counts at once
    bool wants_calls = false;     ///< what moves an axis is to be called in each scan of its task
    bool stops_at_directions = false;  ///< of MC_Power: a direction that is not enabled is no error
    bool fails_without_power = false;  ///< of MC_Power: without Enable in motion it is an error
};

inline constexpr RulesOfVendor rules_of_vendors[] = {
    {},
    {.one_waits = true,
     .ends_endless = true,
     .halts_where_due = true,
     .reset_ends_stop = true,
     .stops_at_directions = true,
     .fails_without_power = true},
    {.blends_moves_only = true,
     .keeps_superimposed = true,
     .leaves_groups = true,
     .exchanges_cams = true,
     .wants_calls = true},
};
static_assert(std::size(rules_of_vendors) == std::size(command_rules_names));

constexpr const RulesOfVendor& rules_of(CommandRules rules) {
    return rules_of_vendors[static_cast<std::size_t>(rules)];
}

}  // namespace lineshaft

#pragma once

#include "blocks/motion/cam_table_select.hpp"
#include "blocks/motion/digital_cam_switch.hpp"
#include "blocks/motion/digital_signals.hpp"
#include "blocks/motion/moves.hpp"
#include "blocks/motion/probes.hpp"
#include "blocks/motion/reads.hpp"
#include "blocks/motion/settings.hpp"
#include "blocks/motion/state_commands.hpp"
#include "blocks/motion/synchronous.hpp"
#include "runtime/model/kept_state.hpp"

/// Which states that were kept commands can go on with.
namespace lineshaft {

bool is_valid(const CommandState& command);
bool is_valid(const CommandBlock& command, const KeptState& machine);
/// Ends where it was: its axis has nothing to do after a restart.
void mend(CommandBlock& command, const KeptState& machine);
bool is_valid(const Home& home, const KeptState& machine);
bool is_valid(const CamTableSelect& select, const KeptState& machine);
bool is_valid(const ReadMotionState& read, const KeptState& machine);
bool is_valid(const TouchProbe& probe, const KeptState& machine);
bool is_valid(const DigitalCamSwitch& cam_switch, const KeptState& machine);
bool is_valid(const DigitalOutputs& outputs, const KeptState& machine);
/// Forgets what was to be written: its task counts its scans anew.
void mend(DigitalOutputs& outputs, const KeptState& machine);
bool is_valid(const WriteDigitalOutput& write, const KeptState& machine);

}  // namespace lineshaft

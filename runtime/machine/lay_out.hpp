#pragma once

#include <cstdint>

#include "runtime/machine/machine.hpp"
#include "runtime/names/net.hpp"

namespace lineshaft {

/// Puts the net's blocks into memory and its wires into the flat lists of the tasks. Of a net with
/// mistakes it lays out what is known, so that what else names signals can be checked, too.
Machine lay_out(const Net& net);

/// Fills the calls of each task, with their wires: lay_out_calls.cpp. `sequence` are the known
/// instances as they stand in memory.
void lay_out_calls(const Net& net, const std::vector<int>& sequence, const std::vector<int>& levels,
                   Machine& machine);

}  // namespace lineshaft

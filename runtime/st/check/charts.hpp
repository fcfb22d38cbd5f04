#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A variable for each step of the charts that the routine and its actions have, with its X and T,
/// and what these keep from scan to scan. Tells steps that are not there, or there twice.
void declare_charts(Checking& c, Routine& routine);

/// What a scan of the chart of a routine, or of an action, does: its evolution, then its actions.
/// IEC 61131-3:2013, 6.7.6. That of an action stands still while the action is not called.
Block chart_statements(Checking& c, Routine& routine);

}  // namespace lineshaft::st

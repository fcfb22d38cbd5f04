#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// A variable for each step of the routine's chart, with its X and T, and what the chart keeps from
/// scan to scan. Tells steps that are not there, or there twice.
void declare_chart(Checking& c, Routine& routine);

/// What a scan of the chart does: its evolution, then its actions. IEC 61131-3:2013, 6.7.6.
Block chart_statements(Checking& c, Routine& routine);

}  // namespace lineshaft::st

#pragma once

#include <vector>

#include "runtime/outside/outside.hpp"
#include "runtime/trace/recorder.hpp"

namespace lineshaft {

/// The traces that the program describes, in the order of the file.
std::vector<TraceSetup> connect_traces(const Connecting& to);

}  // namespace lineshaft

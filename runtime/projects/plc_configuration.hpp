#pragma once

#include <memory>

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// The names that CoDeSys 2.3 gives to inputs and outputs between PLC_CONFIGURATION and PLC_END, as
/// a list of globals at their addresses. A channel has the type of its address's size, and is a
/// REAL where its section is named so.
void read_plc_configuration(const Reading& to, const std::shared_ptr<const SourceFile>& source);

}  // namespace lineshaft::projects

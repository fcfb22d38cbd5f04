#pragma once

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// What TwinCAT makes of classes of events where the sources name them: `TC_EVENTS.Class.Event` is
/// a TcEventEntry, and `TC_EVENT_CLASSES.Class` its GUID. They stand in the `.tmc` files of the
/// project's folder, and in those and the `.tsproj` of the folder above. What cannot be read there
/// is not told: it is not the project's text.
void read_event_classes(const Reading& to, const std::string& plcproj, const Mark& where);

}  // namespace lineshaft::projects

#pragma once

#include "runtime/projects/drawings/networks.hpp"

namespace lineshaft::projects {

/// A sequential function chart (SFC) as TwinCAT keeps it, as steps and transitions.
///
/// Elements stand one below the other; a branch has stretches of them side by side, of which one is
/// gone through, or all. A macro is what stands in it. `pou` has the transitions that have a name,
/// and says which flags (SFCInit and its like) the chart looks at, which are declared then.
Excerpts text_of_step_chart(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                            pugi::xml_node body, pugi::xml_node pou);

}  // namespace lineshaft::projects

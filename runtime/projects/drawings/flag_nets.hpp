#pragma once

#include "runtime/projects/drawings/networks.hpp"

namespace lineshaft::projects {

/// A network of SimaticML, LAD or FBD (`<FlgNet>`), as statements in SCL: parts in the order in
/// which they stand, each behind those whose outputs it takes.
Excerpts text_of_flag_net(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                          pugi::xml_node net, int network);

}  // namespace lineshaft::projects

#pragma once

#include "runtime/projects/drawings/networks.hpp"

namespace lineshaft::projects {

/// A body of networks as TwinCAT keeps it (`<NWL>`), as statements: LD and FBD are one there.
///
/// A network is a list of trees: boxes with the trees that lead to their inputs, assignments,
/// operands, branches beside each other. A wire that leads to several is defined by its number, and
/// named by it elsewhere. What is evaluated first stands first.
/// `is_kept`: variables keep their values from scan to scan.
Excerpts text_of_box_trees(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                           bool is_kept, pugi::xml_node body);

}  // namespace lineshaft::projects

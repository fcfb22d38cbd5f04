#pragma once

#include "runtime/projects/drawings/networks.hpp"

namespace lineshaft::projects {

/// A continuous function chart (CFC) as TwinCAT keeps it, as statements.
///
/// Elements stand anywhere; pins have numbers, and connections lead from one to another. They are
/// evaluated as they stand in the file, which is the order that they are numbered in. Where the
/// chart orders itself by its data flow (`UseExplicitExecutionOrder` is false), networks follow
/// each other from top to bottom, and elements of one by their positions, each behind those that
/// lead to it. What goes back to an element has the value of the last scan.
/// `is_kept`: variables keep their values from scan to scan.
Excerpts text_of_function_chart(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                                bool is_kept, pugi::xml_node body);

}  // namespace lineshaft::projects

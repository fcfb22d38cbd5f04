#pragma once

#include "runtime/projects/excerpts.hpp"
#include "runtime/source/yaml.hpp"

namespace lineshaft::projects {

/// Ladders as OpenPLC Editor 4 keeps them, `{"rungs": [{"nodes": [...], "edges": [...]}]}`, as the
/// `<LD>` of PLCopen XML. What is no contact, coil, box, variable or wire is told.
Excerpts ladder_of_rungs(const Node& ladder, Diagnostics& out);

/// What stands between tags of XML, or in quotes there.
std::string as_xml(std::string_view text);

}  // namespace lineshaft::projects

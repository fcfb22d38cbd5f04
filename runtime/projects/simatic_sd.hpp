#pragma once

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// A block, a type or a data block as a SIMATIC SD document (`.s7dcl`): SCL, whose networks of LAD
/// and FBD become statements.
void read_simatic_sd(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects

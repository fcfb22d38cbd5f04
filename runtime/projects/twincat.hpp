#pragma once

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// `.TcPOU`, `.TcDUT`, `.TcGVL`, `.TcIO`: one declaration with what belongs to it, as one text.
/// `.TcTTO`: a task.
void read_twincat_object(const Reading& to, const std::string& path, const Mark& where);

/// `.plcproj`: the files that it lists, and the libraries that it refers to.
void read_plcproj(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects

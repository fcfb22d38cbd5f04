#pragma once

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// Whether a `.prg` of B&R is one of IEC languages, and not of C.
bool is_iec_program(const std::filesystem::path& file);

/// `IEC.prg`: a program of the name of its folder, out of the files that it lists. `.var` declares
/// its variables, `PROGRAM _CYCLIC` is its body, `PROGRAM _INIT` runs in front of the first of it,
/// and each ACTION is its own. `PROGRAM _EXIT` is left out: nothing ends a program here.
void read_iec_program(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects

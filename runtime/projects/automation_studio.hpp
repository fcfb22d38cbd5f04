#pragma once

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// Whether a `.prg` of B&R is one of IEC languages, and not of C.
bool is_iec_program(const std::filesystem::path& file);

/// `IEC.prg`: a program of the name of its folder, out of the files that it lists, and those of the
/// packages that it has. `.var` declares its variables, `PROGRAM _CYCLIC` is its body, `PROGRAM
/// _INIT` runs in front of the first of it, and each ACTION is its own. In a `.ld` they are drawn.
/// `PROGRAM _EXIT` is left out: nothing ends a program here.
void read_iec_program(const Reading& to, const std::string& path, const Mark& where);

/// Whether a file is below `Physical`, beside which `Logical` has the sources.
bool is_of_hardware(const std::filesystem::path& file);

/// Whether a file of the hardware configures axes or components: `mappMotion/x.axis`,
/// `mappServices/x.mpalarmxcore` and their like.
bool is_mapp_configuration(const std::filesystem::path& file);

/// Each Element is a global variable: an axis a McAxisType, which is AXIS_REF, a group a
/// McAxesGroupType, of a track and of pick and place its parts, others a MpComIdentType, which
/// programs refer to as MpLink. So is what a list of process points or traffic objects names.
/// Several configurations of a project may have it.
void read_mapp_configuration(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects

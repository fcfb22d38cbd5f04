#pragma once

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

class XmlFile;

/// Whether it is XML of IEC 61131-10, as Sysmac Studio and PLCnext Engineer export it.
bool is_standard_xml(const XmlFile& file);

/// Such a project in the form of PLCopen TC6, whose words know where they stand: types, POUs, lists
/// of globals, bodies in ST, LD and FBD. Sections and rungs of a ladder follow each other as they
/// stand. What stands in a namespace is there without its name. A body in another language, and an
/// element that is not read, are told in `out`.
std::shared_ptr<const SourceFile> plcopen_of_standard_xml(const XmlFile& file, Diagnostics& out);

}  // namespace lineshaft::projects

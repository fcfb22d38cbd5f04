#pragma once

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// Whether a file begins as PLCopen XML does: `<project>` of one of its namespaces.
bool is_plcopen(const std::filesystem::path& file);

class XmlFile;

/// A project that was put together as MatIEC's editors write it.
void read_plcopen_of_matiec(const Reading& to, const XmlFile& file);

/// PLCopen TC6 XML: each POU, type and list of globals as one text, tasks with the programs that
/// they call, and what CODESYS has beside: methods, properties, lists, and declarations as text,
/// which are taken instead of those in elements.
void read_plcopen(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects

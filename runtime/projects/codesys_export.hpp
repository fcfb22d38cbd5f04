#pragma once

#include <filesystem>
#include <string>

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// Looked into: others have files of that ending, too.
bool is_codesys_export(const std::filesystem::path& file);

/// `.export` of CODESYS 3, its own XML: objects with the lines of their texts, methods, properties
/// and actions as objects of their own, which name what they belong to.
void read_codesys_export(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects

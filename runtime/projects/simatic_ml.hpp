#pragma once

#include <filesystem>

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// Whether a file begins as one of SimaticML does, and holds a block, a type or a table of tags.
bool is_simatic_ml(const std::filesystem::path& file);

/// What TIA Portal's Openness and its version control export (`.xml`): blocks in SCL, LAD and FBD,
/// data blocks, PLC data types and tag tables, each as one text in SCL. Other languages are told.
void read_simatic_ml(const Reading& to, const std::string& path, const Mark& where);

}  // namespace lineshaft::projects

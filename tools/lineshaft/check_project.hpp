#pragma once

#include <string>

#include "runtime/program/program.hpp"

namespace lineshaft {

/// Whether a path is a project of another tool, or a folder with files of one.
bool is_project(const std::string& path);

/// Compiles a project, tells what is wrong in `out`, and returns a page for people: how much of it
/// runs, and what does not by cause, with counts and the first place of each.
std::string check_project(const std::string& path, const LoadOptions& options, Diagnostics& out);

}  // namespace lineshaft

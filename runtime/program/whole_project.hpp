#pragma once

#include <string>
#include <vector>

#include "runtime/model/library_reference.hpp"
#include "runtime/program/program.hpp"

namespace lineshaft {

/// A project of another tool with what it takes from others.
struct WholeProject {
    std::string path;           ///< of its `.plcproj` or its folder, or as it was named
    projects::Project project;  ///< `libraries` are those whose sources are not here
    std::size_t own = 0;        ///< its own sources, the first ones; behind them its libraries'
    std::vector<std::string> library_paths = {};  ///< the `.plcproj` of these
};

/// What a path leads to: each `.plcproj` for itself, and each of several projects of Automation
/// Studio, which have what is in none of them beside; all else together. The libraries of one are
/// the projects below the path (of a file its folder), or below an include directory, that are
/// called so: their sources, and those of their libraries, stand each in its namespace.
std::vector<WholeProject> read_projects(const std::string& path,
                                        const std::vector<std::string>& include_dirs,
                                        Diagnostics& out);

/// What its tasks run.
std::vector<std::string> task_programs(const projects::Project& project);

/// The libraries that it refers to and that are not here, for the compiler to name.
std::vector<LibraryReference> references_of(const projects::Project& project);

}  // namespace lineshaft

#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runtime/projects/project.hpp"

/// Projects of TwinCAT beside each other: a solution names several, and one is another's library.
namespace lineshaft::projects {

/// What a `.plcproj` is called where others refer to it, and what it refers to itself.
struct ProjectNames {
    struct Library {
        std::string name;   ///< `TcUnit` of `TcUnit,1.2.0.0,www.tcunit.org`
        std::string space;  ///< the namespace that its names stand in, as this project says
    };
    std::vector<std::string> own;  ///< its title, its name, its file's
    std::vector<Library> libraries;

    bool is_called(std::string_view name) const;
};

ProjectNames names_of_plcproj(const std::string& path);

/// `.sln`, `.tsproj`, `.tspproj`, `.xti`.
bool is_solution(const std::filesystem::path& file);

/// The `.plcproj` that a solution or what it names leads to; those that are not there are left out.
std::vector<std::string> plcprojs_of(const std::string& solution);

/// Reads all that a solution leads to.
void read_solution(const Reading& to, const std::string& path, const Mark& where);

/// A source as one of a library: all in it stands in the namespace.
std::shared_ptr<const SourceFile> in_namespace(const std::shared_ptr<const SourceFile>& source,
                                               const std::string& space);

}  // namespace lineshaft::projects

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lineshaft::projects {

/// What B&R's projects list below `Logical`: a `Package.pkg` the files and folders beside it, and
/// an `IEC.lby` the files of its library. Automation Studio compiles nothing else.
class Packages {
  public:
    /// Whether a list beside the file, or beside a folder that it lies in, leaves that out; and of
    /// Structured Text, which a package may have for other interpreters, each that is beside one.
    bool leave_out(const std::filesystem::path& file);

  private:
    const std::string& list_of(const std::filesystem::path& folder);

    std::map<std::filesystem::path, std::string> lists_;  ///< by their folders, in small letters
};

/// The folder whose `Logical`, or `Physical` beside that, a file is below: that of a project of
/// Automation Studio. Empty: it is of none.
std::string studio_project_of(const std::filesystem::path& file);

/// The namespace of what a package has for itself and those below it: `_Logical._Cell`, of the
/// folder. Empty: the `Package.pkg` beside the file does not say `Private="true"` of it.
std::string private_space_of(const std::filesystem::path& file);

/// The files that packages have for themselves which a program in that folder is below.
std::vector<std::string> private_files_above(const std::filesystem::path& folder);

}  // namespace lineshaft::projects

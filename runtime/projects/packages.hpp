#pragma once

#include <filesystem>
#include <map>
#include <string>

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

}  // namespace lineshaft::projects

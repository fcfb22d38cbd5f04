#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lineshaft::projects {

/// A file of another tool in a form that is not read.
struct ForeignFile {
    std::string what;  ///< `a project of Rockwell's Logix Designer`
    std::string help;  ///< what to do instead
};

/// What a file is by its name, or in what folder it stands; empty: nothing is known of it.
std::optional<ForeignFile> foreign_file(const std::filesystem::path& file);

/// Such files below a folder, by the ending of their names: `2 .L5X (projects of ...)`; empty:
/// there are none.
std::string foreign_files_below(const std::filesystem::path& folder);

}  // namespace lineshaft::projects

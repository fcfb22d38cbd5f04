#pragma once

#include <filesystem>
#include <system_error>

namespace lineshaft {

/// Whether a folder's entry is a regular file, or a link that leads back to itself, which whoever
/// reads it tells.
inline bool is_file_to_read(const std::filesystem::directory_entry& entry) {
    std::error_code unknown;
    return entry.is_regular_file(unknown) || unknown == std::errc::too_many_symbolic_link_levels;
}

}  // namespace lineshaft

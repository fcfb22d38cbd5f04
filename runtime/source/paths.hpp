#pragma once

#include <filesystem>
#include <string>

#include "runtime/source/letters.hpp"

namespace lineshaft {

/// How the name of a file ends, in small letters: `.st`; empty: it has no ending.
inline std::string extension_of(const std::filesystem::path& file) {
    return lower(file.extension().string());
}

/// Whether a file stands in a folder or in one below it, by their names: without links and dots.
inline bool lies_below(const std::filesystem::path& file, const std::filesystem::path& folder) {
    const auto relative = file.lexically_relative(folder);
    return !relative.empty() && *relative.begin() != "..";
}

}  // namespace lineshaft

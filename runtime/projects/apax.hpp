#pragma once

#include <filesystem>
#include <vector>

namespace lineshaft::projects {

/// Packages of SIMATIC AX beside the one in `folder` that its `apax.yml` depends on, and that those
/// depend on: their folders, each once, by the names that their own `apax.yml` say. Not those that
/// are installed below it, in `.apax`.
std::vector<std::filesystem::path> packages_beside(const std::filesystem::path& folder);

/// The package that a file or a folder belongs to: the nearest folder, it or one above it, with
/// `apax.yml` and `src`, named from where `path` is named. Empty: none.
std::filesystem::path package_of(const std::filesystem::path& path);

}  // namespace lineshaft::projects

#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft::projects {

/// Packages of SIMATIC AX beside the one in `folder` that its `apax.yml` depends on, and that those
/// depend on: their folders, each once, by the names that their own `apax.yml` say. Not those that
/// are installed below it, in `.apax`.
std::vector<std::filesystem::path> packages_beside(const std::filesystem::path& folder);

/// The package that a file or a folder belongs to: the nearest folder, it or one above it, with
/// `apax.yml` and `src`, named from where `path` is named. Empty: none.
std::filesystem::path package_of(const std::filesystem::path& path);

/// `{::ifdef X}` in a source of a package asks for what `variables: DEFINED_PREPROCESSOR_SYMBOLS:`
/// of its `apax.yml` lists: the source with `{define X}` before it. Any other as it is.
std::shared_ptr<const SourceFile> with_symbols(std::shared_ptr<const SourceFile> source);

}  // namespace lineshaft::projects

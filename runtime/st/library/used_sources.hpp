#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/st/library/library.hpp"

namespace lineshaft::st {

/// As `compile`. Where that fails, once more without what names do not lead to from `roots`, names
/// of PROGRAMs and blocks, on: of a project's objects the tools of controllers compile those that
/// its tasks use, and many a project has others that are long out of date. What is first wrong in
/// each file left out is a warning. Files of Structured Text alone are never left out, and nothing
/// is without roots.
std::optional<Library> compile_used(const std::vector<std::shared_ptr<const SourceFile>>& sources,
                                    const std::vector<std::string>& roots, const Catalog& standard,
                                    Diagnostics& out, const Options& options = {});

}  // namespace lineshaft::st

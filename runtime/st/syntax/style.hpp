#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft::st {

/// The source in the one style: four blanks for what stands within something, one blank where
/// blanks stand, at most one empty line, lines broken where they were. Its tokens, comments and
/// pragmas are the same, and what is in the style stays as it is. Empty: something in it is no
/// token, or is left out by a `{IF ...}`, which goes to `out`.
std::optional<std::string> in_style(const std::shared_ptr<const SourceFile>& file,
                                    Diagnostics& out);

}  // namespace lineshaft::st

#pragma once

#include <memory>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft::projects {

/// A text of which bodies are instruction lists (IL), with these as statements; or the text as it
/// is, which has none. What is wrong in a list is told in `out`.
std::shared_ptr<const SourceFile> with_lists_as_statements(std::shared_ptr<const SourceFile> text,
                                                           Diagnostics& out);

}  // namespace lineshaft::projects

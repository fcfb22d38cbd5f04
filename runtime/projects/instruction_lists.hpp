#pragma once

#include <memory>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft::projects {

/// A text of which bodies are instruction lists (IL), with these as statements; or the text as it
/// is, which has none. What is wrong in a list is a mistake of the text.
std::shared_ptr<const SourceFile> with_lists_as_statements(std::shared_ptr<const SourceFile> text);

}  // namespace lineshaft::projects

#pragma once

#include "runtime/source/diagnostic.hpp"
#include "runtime/st/library/test_sources.hpp"

namespace lineshaft {

using Texts = std::vector<std::shared_ptr<const SourceFile>>;

/// What is wrong with texts, together with those of `pool` that declare what they name, the nearest
/// by path: two programs may have different ones of a name.
Diagnostics check_apart(const st::SourcePool& pool, const Texts& texts);

/// `found` is what is wrong with texts that were compiled together. Where a name is declared twice,
/// several programs stand beside each other, as in a folder of examples: then each folder where
/// there is a mistake is looked at again, apart, each file of another tool, and each file that is a
/// program of its own: one of several in a folder with a PROGRAM that declare the same type or
/// block, or the same PROGRAM without naming anything of others. What is declared twice in two of
/// them is a warning.
Diagnostics without_neighbours(const Texts& texts, const Diagnostics& found);

}  // namespace lineshaft

#pragma once

#include "runtime/st/checker.hpp"
#include "runtime/st/code.hpp"

namespace lineshaft::st {

/// Lays out the memory of all types and routines (notes slots in them), and writes their code.
/// `images` has that of each block and each global by its type: an instance as it begins.
struct Generated {
    Code code;
    std::unordered_map<const Type*, std::vector<std::uint64_t>> images;
};

/// L0912: more memory than a block may have. Code that `counts` its instructions has none fused.
Generated generate(Checked& checked, Diagnostics& out, bool counts);

}  // namespace lineshaft::st

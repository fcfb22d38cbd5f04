#pragma once

#include <cstdint>
#include <vector>

#include "runtime/st/code/code.hpp"

namespace lineshaft::st {

/// Instructions that are repeated, from the first to that which goes back.
struct Loop {
    std::uint32_t first = 0, last = 0;
};

/// How the instructions of a code follow each other.
struct Flow {
    std::vector<bool> labels;  ///< by instruction: it is also gone to
    /// Short ones, that nothing comes into but to their first instruction, without loops and calls
    /// inside and without what writes other slots than those of its operands.
    std::vector<Loop> loops;
};

Flow flow_of(const Code& code);

}  // namespace lineshaft::st

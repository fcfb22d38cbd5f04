#pragma once

#include <cstdint>
#include <string>

#include "runtime/source/wide.hpp"

namespace lineshaft::st {

using lineshaft::Wide;

/// Both are within +-2^64. A product beyond Wide comes to another number outside of +-2^64.
inline Wide product(Wide a, Wide b) {
    __extension__ using Bits = unsigned __int128;
    return static_cast<Wide>(static_cast<Bits>(a) * static_cast<Bits>(b));
}

/// A value known when compiling. Of BOOL, integers, times, bit strings and enumerations `integer`
/// counts, of REAL and LREAL `real`, of STRING `text`.
struct Constant {
    Wide integer = 0;
    double real = 0;
    std::string text = {};
};

}  // namespace lineshaft::st

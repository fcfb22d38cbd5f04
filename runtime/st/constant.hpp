#pragma once

#include <cstdint>
#include <string>

namespace lineshaft::st {

__extension__ using Wide = __int128;

/// A value known when compiling. Of BOOL, integers, times, bit strings and enumerations `integer`
/// counts, of REAL and LREAL `real`, of STRING `text`.
struct Constant {
    Wide integer = 0;
    double real = 0;
    std::string text = {};
};

}  // namespace lineshaft::st

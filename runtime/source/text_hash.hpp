#pragma once

#include <string>
#include <string_view>

namespace lineshaft {

/// XXH3, 64 bits, as 16 hexadecimal digits: tells whether two texts are the same.
std::string text_hash(std::string_view text);

}  // namespace lineshaft

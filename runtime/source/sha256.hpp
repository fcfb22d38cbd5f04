#pragma once

#include <string>
#include <string_view>

namespace lineshaft {

/// 64 hexadecimal digits, as FIPS 180-4 has them.
std::string sha256(std::string_view bytes);

}  // namespace lineshaft

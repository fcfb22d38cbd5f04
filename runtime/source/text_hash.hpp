#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace lineshaft {

/// XXH3, 64 bits, as 16 hexadecimal digits: tells whether two texts are the same.
std::string text_hash(std::string_view text);

/// Two small digits a byte.
std::string hexadecimal(std::span<const std::byte> bytes);

}  // namespace lineshaft

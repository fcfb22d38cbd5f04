#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lineshaft {

/// CRC-32 as zlib, gzip and Python's zlib.crc32 compute it: tells damage, not intent.
class Checksum {
  public:
    void add(std::string_view bytes);
    std::string text() const;  ///< 8 hexadecimal digits

  private:
    std::uint32_t value_ = 0;
};

}  // namespace lineshaft

#include "runtime/trace/checksum.hpp"

#include <fmt/format.h>
#include <zlib.h>

namespace lineshaft {

void Checksum::add(std::string_view bytes) {
    value_ = static_cast<std::uint32_t>(
        ::crc32_z(value_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

std::string Checksum::text() const {
    return fmt::format("{:08x}", value_);
}

}  // namespace lineshaft

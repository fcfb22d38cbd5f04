#include "runtime/csv/checksum.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

namespace lineshaft {

void Checksum::add(std::string_view bytes) {
    value_ = ::libdeflate_crc32(value_, bytes.data(), bytes.size());
}

std::string Checksum::text() const {
    return fmt::format("{:08x}", value_);
}

}  // namespace lineshaft

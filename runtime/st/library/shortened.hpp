#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "runtime/model/catalog.hpp"

namespace lineshaft::st {

/// So many fields a kind of some library has: of what stands in arrays, and of other parts of
/// variables. A kind takes memory for each field, and so does each block of it for its signal.
inline constexpr std::size_t most_elements = 4096, most_parts = 65536;

/// Variables of a kind, by their paths, of which not all are fields, as there are more. Of a kind
/// that is not of a library none.
std::span<const std::string_view> shortened_variables(const BlockType& kind);

/// That one of these which `field` is a part of; empty: of none. Capital letters make no
/// difference.
std::string_view find_shortened(const BlockType& kind, std::string_view field);

}  // namespace lineshaft::st

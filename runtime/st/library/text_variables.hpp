#pragma once

#include <span>
#include <string_view>

#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// A variable of a kind that is a STRING or a WSTRING, and so no field.
struct TextVariable {
    std::string_view name = {};  ///< its path: `table[3].x`
    std::size_t offset = 0;      ///< in the memory of a block
};

/// Those of a kind of some library, as many in arrays as are fields. Of another kind none.
std::span<const TextVariable> text_variables(const BlockType& kind);

/// Its characters now: UTF-8, but of SCL a byte each.
std::string_view text_of(const TextVariable& variable, const std::byte* block);

}  // namespace lineshaft::st

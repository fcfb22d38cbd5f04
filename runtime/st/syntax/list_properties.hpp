#pragma once

#include <string_view>

namespace lineshaft::st {

/// A list of globals in TwinCAT's files may have PROPERTYs. They stand in a block of its own, which
/// is called so and by the list's name, and whose one instance in the list is called so alone.
inline constexpr std::string_view list_properties = "__properties";

}  // namespace lineshaft::st

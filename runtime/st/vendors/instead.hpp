#pragma once

#include <string_view>

namespace lineshaft::st {

/// What to write instead of a type, a function or an input of a block that controllers of Siemens,
/// Beckhoff or CODESYS have and this one does not: half a sentence of a message. Empty for any
/// other name; capital letters make no difference.
std::string_view instead_of_type(std::string_view name);
std::string_view instead_of_function(std::string_view name);
std::string_view instead_of_input(std::string_view name);

}  // namespace lineshaft::st

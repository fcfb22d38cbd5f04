#pragma once

#include "runtime/st/lexer.hpp"

namespace lineshaft::st {

/// Standard types and functions that are Structured Text themselves: DTL and its conversions, and
/// those of IEC 61131-3:2013, table 35, that put dates together and take them apart. What is no
/// date (the 30th of February) is the fault `out_of_range`. A source may declare one of their names
/// itself.
const std::shared_ptr<const SourceFile>& standard_source();

/// A source has one of its names.
bool uses_standard_source(const Tokens& tokens);

}  // namespace lineshaft::st

#pragma once

#include "runtime/model/catalog.hpp"
#include "runtime/st/syntax/lexer.hpp"

namespace lineshaft::st {

/// Standard types and functions that are Structured Text themselves: DTL and its conversions, those
/// of IEC 61131-3:2013, table 35, that put dates together and take them apart, and Siemens' of
/// texts, characters, digits, bytes, the clock and the process image. What is no date (the 30th of
/// February) is the fault `out_of_range`. A source may declare one of their names itself.
const std::shared_ptr<const SourceFile>& standard_source();

/// A source has one of its names.
bool uses_standard_source(const Tokens& tokens);

/// A function or a type of it has that name.
bool is_in_standard_source(std::string_view name);

/// What a kind of the catalogue says in Structured Text.
std::shared_ptr<const SourceFile> source_of(const BlockType& type);

/// A source has a name of a part that `type` says.
bool uses_source_of(const BlockType& type, const Tokens& tokens);

}  // namespace lineshaft::st

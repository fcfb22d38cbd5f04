#pragma once

#include "runtime/st/syntax/token.hpp"

/// Pragmas that choose parts of a source, as CODESYS has them.
namespace lineshaft::st {

/// `{IF defined (x)}` begins with `IF`, whatever its letters.
bool says_pragma(std::string_view pragma, std::string_view word);

/// The condition of `{IF ...}` or `{ELSIF ...}`: `defined (x)`, NOT, AND, OR, parentheses. What
/// else can be asked there, of a project or a device, does not hold.
bool holds(std::string_view pragma, const NameSet& defined);

/// `{define x}` and `{undefine x}`.
void note_definition(std::string_view pragma, NameSet& defined);

}  // namespace lineshaft::st

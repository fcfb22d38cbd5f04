#pragma once

#include <utility>

#include "runtime/st/syntax/lexer.hpp"

/// What comments and pragmas say of what they stand beside.
namespace lineshaft::st {

/// The unit, and the pragma that says it, between two tokens or behind the last in its line. Empty
/// without one.
std::pair<std::string_view, Place> unit_between(const Tokens& tokens, std::size_t first,
                                                std::size_t last);

/// `{attribute 'name'}` stands before a token, and behind the one before that.
bool has_attribute(const Tokens& tokens, std::size_t token, std::string_view name);

/// `{CallerFilePath}` or `{CallerLineNumber}` of SIMATIC AX stands before it.
bool is_of_caller(const Tokens& tokens, std::size_t token);

/// The comments before a token that begin their lines, or that do not: those behind the last empty
/// line.
std::string_view comment_before(const Tokens& tokens, std::size_t token, bool first_in_line);

}  // namespace lineshaft::st

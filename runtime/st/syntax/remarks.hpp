#pragma once

#include <utility>

#include "runtime/st/syntax/lexer.hpp"
#include "runtime/st/syntax/token.hpp"

/// What comments and pragmas say of what they stand beside.
namespace lineshaft::st {

/// The unit, and the pragma that says it, between two tokens or behind the last in its line. Empty
/// without one.
std::pair<std::string_view, Place> unit_between(const Tokens& tokens, std::size_t first,
                                                std::size_t last);

/// `{attribute 'name'}` stands before a token, and behind the one before that.
bool has_attribute(const Tokens& tokens, std::size_t token, std::string_view name);

/// The value of `{attribute 'name' := 'value'}` there; empty without one.
std::string_view attribute_value(const Tokens& tokens, std::size_t token, std::string_view name);

/// 5 of `{S7_BlockNumber := "5"}`, which stands before it; empty without one.
std::string_view block_number(const Tokens& tokens, std::size_t token);

/// `{CallerFilePath}` or `{CallerLineNumber}` of SIMATIC AX stands before it.
bool is_of_caller(const Tokens& tokens, std::size_t token);

/// The comments before a token that begin their lines, or that do not: those behind the last empty
/// line.
std::string_view comment_before(const Tokens& tokens, std::size_t token, bool first_in_line);

// conditions.cpp

/// Pragmas that choose parts of a source, as CODESYS has them.
/// `{IF defined (x)}` begins with `IF`, whatever its letters.
bool says_pragma(std::string_view pragma, std::string_view word);

/// The end of what is quoted in a pragma from `begin` on; 0 if nothing is. It may go over lines,
/// where neither the brace stands in its first one, nor the other quote belongs to something else.
std::size_t end_of_quoted(std::string_view text, std::size_t begin);

/// Names that `{define}` has made known, with the value that it gives them.
using Definitions = NameMap<std::string_view>;

/// `{IF ...}`; `{::ifdef X}` and `{::ifndef X}` of SIMATIC AX.
bool begins_choice(std::string_view pragma);

/// The condition of `{IF ...}` or `{ELSIF ...}`: `defined (x)`, `hasvalue (x, '1')`, NOT, AND, OR,
/// parentheses. What else can be asked there, of a project or a device, does not hold.
bool holds(std::string_view pragma, const Definitions& defined);

/// `{END_IF}`
bool ends_choice(std::string_view pragma);

/// Where a part that does not hold ends: at the last character of a pragma.
struct LeftOut {
    std::size_t last = 0;
    bool ends_choice = false;  ///< all of it; else what follows holds
};

/// Where the part of an `{IF}` behind `at` ends; `may_choose`: none of the parts before it held.
LeftOut left_out(std::string_view text, std::size_t at, bool may_choose,
                 const Definitions& defined);

/// `{define x}`, `{define x '1'}` and `{undefine x}`.
void note_definition(std::string_view pragma, Definitions& defined);

}  // namespace lineshaft::st

#pragma once

#include <cstddef>
#include <string_view>

namespace lineshaft::st {

// What stands in sources and is none of the language.

/// CoDeSys 2.3 exports pictures, what is connected, alarms, libraries and tasks beside its units,
/// in languages of their own: behind the one that `word`, which ends at `at`, begins; npos: it is
/// none.
std::size_t end_of_section(std::string_view text, std::size_t at, std::string_view word);

/// Behind a comment at `at` that is none by the language's rules; 0: it is one. Behind a program
/// OpenPLC has C with its own `*)` for its debugger, line by line; PC WORX and MULTIPROG have free
/// text between `(*@KEY@:DESCRIPTION*)` and `(*@KEY@:END_DESCRIPTION*)`.
std::size_t end_of_tools_comment(std::string_view text, std::size_t at);

/// Where a merge of git has left two versions at the beginning of a line: behind the line
/// `<<<<<<< ours`, or from `=======` on behind `>>>>>>> theirs`; npos: it has not.
std::size_t end_of_conflict(std::string_view text, std::size_t at);

/// TIA's comment in several languages begins at `at`: `(/* ... */)`.
bool is_translated_comment(std::string_view text, std::size_t at);

/// Behind `{{ C }}` of matiec's compilers and `{external C++ }` of STruCpp, in which braces nest,
/// which a program runs as well without; npos: it is none.
std::size_t end_of_foreign_code(std::string_view text, std::size_t at);

/// `TITLE = any text`, to the end of its line; `word` ends at `at`.
bool is_title(std::string_view text, std::size_t at, std::string_view word);

/// What to write for a sign of another language, with which `text` begins.
std::string_view instead_of(std::string_view text);

}  // namespace lineshaft::st

#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/st/syntax/lexer.hpp"
#include "runtime/st/syntax/remarks.hpp"

namespace lineshaft::st {

/// A text that is taken apart: where the next character is, and what it has become so far. What
/// reads a token (`lexer`), a comment or a pragma (`blanks`) moves it on.
struct TextCursor {
    std::string_view text;
    const Dialect& dialect;
    Diagnostics& out;
    Tokens tokens = {};
    std::size_t at = 0;             ///< of the next character
    std::size_t start = 0;          ///< of the token that is read
    bool new_line = true;           ///< no token stands before the next one in its line
    bool has_foreign_code = false;  ///< which was told
    std::size_t last_foreign = std::string_view::npos;  ///< end of the last character of no token
    std::vector<Place> choices = {};                    ///< each `{IF}` that is open
    Definitions defined = {};                           ///< by `{define}`

    TextCursor(const std::shared_ptr<const Source>& source, Diagnostics& diagnostics);

    char peek(std::size_t ahead = 0) const {
        return at + ahead < text.size() ? text[at + ahead] : '\0';
    }
    bool is_at(std::string_view next) const {
        return peek() == next[0] && text.substr(at).starts_with(next);
    }
    Place place(std::size_t begin, std::size_t end) const;
    template <class Condition>
    void skip_while(Condition condition) {
        while (at < text.size() && condition(text[at])) ++at;
    }
    /// Bytes of a letter beyond ASCII that is next; 0 where there is none.
    std::size_t national_letter() const;
    void skip_name();
    void skip_to_end_of_line();
    /// A token from `start` to here.
    Token& add(Word word);
    /// After `word.` a number is that of a bit, and a word a name.
    bool is_after_dot() const;
    void fail(Place where, std::string message, std::string help);
};

}  // namespace lineshaft::st

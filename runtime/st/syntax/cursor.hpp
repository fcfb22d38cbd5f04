#pragma once

#include "runtime/st/syntax/lexer.hpp"
#include "runtime/st/syntax/words.hpp"

namespace lineshaft::st {

/// The tokens of a source, and where the parser is in them.
struct Cursor : Tokens {
    std::size_t at = 0;
    bool panic = false;  ///< after a mistake nothing is accepted, until recovery.hpp finds a place

    const Token& here() const { return tokens[at]; }
    const Token& next(std::size_t ahead = 1) const {
        return tokens[std::min(at + ahead, tokens.size() - 1)];
    }
    const Token& last() const { return tokens[at == 0 ? 0 : at - 1]; }

    bool is(Word word) const { return here().word == word; }
    bool is_name(std::size_t ahead = 0) const { return st::is_name(next(ahead).word); }
    /// Whether the name is that word, which is reserved only where it has a meaning.
    bool says(std::string_view word) const { return same_name(here().text, word); }
    /// A ':' or ',' is next: what is here is the name of a variable, whatever word it is.
    bool is_declared() const { return next().word == Word::colon || next().word == Word::comma; }

    const Token& take() { return is(Word::end_of_file) ? here() : tokens[at++]; }
    bool accept(Word word) {
        if (panic || !is(word)) return false;
        take();
        return true;
    }

    /// A program organization unit or a PROPERTY begins; `METHOD` may be the name of a variable.
    bool at_pou() const {
        if (is(Word::property_) || (is_name() && find_pou(here().word))) return is_name(1);
        return find_pou(here().word) != nullptr;
    }
    bool at_method() const { return (is(Word::method_) || is(Word::property_)) && is_name(1); }
    /// A TEST has a text behind it; SETUP and TEARDOWN are names, too.
    bool at_test() const;
    /// `MOCK a.b;`, `MOCK_FUNCTION f RETURNS 5;`, `ADVANCE_TIME T#1s;`
    bool at_test_statement() const;
    /// Names, numbers, ranges and commas, and then a colon; one that begins a line is meant.
    bool at_label() const;
    /// `a.b.Colour#red`
    bool at_qualified_prefix() const;
    /// `(x := 1)`, `(1, 2)`, `()`, and not `(1 + 2) * 3`.
    bool at_structure() const;
    /// `x :=`, `x =>`; a word may be one without quotes, as nothing else can be meant.
    bool at_argument_name(std::size_t ahead = 0) const;
    /// `ACTION a`
    bool at_action() const { return is(Word::action_) && is_name(1); }
    /// `NOT q => x`
    bool at_negated_output() const;
    /// `INITIAL_STEP s:`, `STEP s:`, `TRANSITION FROM s TO t` of a sequential function chart.
    bool at_chart() const;
    bool at_end_of_step() const;  ///< END_STEP, which is a name elsewhere
};

}  // namespace lineshaft::st

#pragma once

#include "runtime/st/syntax/cursor.hpp"

namespace lineshaft::st {

/// What parse() knows while it reads a source. The reading is done by functions that take it first:
/// grammar.hpp, recovery.hpp, mistakes.hpp.
struct Parsing : Cursor {
    Tree& tree;
    Diagnostics& out;
    Scope* scope = nullptr;                   ///< that is open; null: none
    Pou* fixture = nullptr;                   ///< that the tests are methods of
    std::vector<Token> regions = {};          ///< that are open
    std::vector<Declaration*> generics = {};  ///< constants of the generic block that is read
    std::vector<Expression*> given = {};      ///< their values, where it is read again
    Block* before = nullptr;  ///< where assignments go that stand in an expression; null: none may
    /// First tokens of the statement, and of what is assigned in it and not yet read to its end.
    std::vector<std::size_t> targets = {};
    int assigned = 0;                  ///< of such assignments in the statement
    int cases = 0;                     ///< that are open, before their ELSE
    int levels = 0;                    ///< that are open
    bool is_in_body = false;           ///< of a POU
    bool is_in_test = false;           ///< in its body
    bool is_wrong = false;             ///< what is being declared
    bool was_wrong = false;            ///< something before it
    bool is_spoiled = false;           ///< the POU, by a variable that cannot be
    bool section_left = false;         ///< a VAR ended without END_VAR
    std::size_t sections_until = 0;    ///< no statement of a bare program stands before
    std::vector<Place> else_ifs = {};  ///< `ELSE IF` within the IFs that are open
    std::size_t unclosed_at = static_cast<std::size_t>(-1);  ///< where an end was missed last

    Expression* make(Expression::Kind kind, const Token& token);
    Statement* make(Statement::Kind kind, const Token& token);

    /// A statement that is no more than a value, or the name of an action.
    Statement* make(Statement::Kind kind, Expression* value);

    /// Takes up `operand`, and makes the place as large.
    void add_operand(Expression& to, int index, Expression* operand);
    /// Makes `to` deeper than a part of it. A chain that is too long is told.
    void grow(Expression& to, const Expression& part);
    /// Tells it, and reads no further.
    void refuse_depth(Place place);
};

/// Counts levels while it lives.
class Level {
  public:
    explicit Level(Parsing& p);
    ~Level() { --p_.levels; }

  private:
    Parsing& p_;
};

/// While it lives, assignments may stand in the expression that is read, if they might before.
class KeepBefore {
  public:
    KeepBefore(Parsing& p, bool may_assign) : p_(p), kept_(p.before) {
        if (!may_assign) p.before = nullptr;
    }
    ~KeepBefore() { p_.before = kept_; }

  private:
    Parsing& p_;
    Block* kept_;
};

}  // namespace lineshaft::st

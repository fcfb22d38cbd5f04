#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

// What the parser wrote stays as it was. What an expression or a statement stands for when it is
// checked is made here, and hung where the old one was: `e = make_constant(c, *e, type, value)`. In
// the parser's nodes are written what the tree says is the checker's, and these links alone. A node
// that has its type may hang in several places.

/// Its value is known, and its type.
bool is_constant(const Expression& expression);
/// The value of a constant that is a number.
double as_real(const Expression& constant);

/// A node where `like` stands, without operands.
Expression* make(Checking& c, E kind, const Expression& like);
/// The same once more.
Expression* make_copy(Checking& c, const Expression& e);
/// Statements that may be checked beside the others, of the same expressions.
Block make_copies(Checking& c, const Block& statements);
/// A value, where `like` stands.
Expression* make_constant(Checking& c, const Expression& like, const Type& type, Constant value);
/// `e` becomes that value, whose type is given. It is never null.
const Type* become(Checking& c, Expression*& e, const Type& type, Constant value);
Expression* make_boolean(Checking& c, const Expression& like, bool value);
Expression* make_dint(Checking& c, const Expression& like, std::int64_t value);
/// `"..."`, which is no name, as the text that it encloses.
Expression* make_text(Checking& c, const Expression& quoted);
/// The variable, where `like` stands.
Expression* make_use(Checking& c, const Expression& like, Variable& variable);
/// `text`, where `like` stands.
Expression* make_name(Checking& c, const Expression& like, std::string_view text);
/// That of a function, where `like` stands, which may be `#x` or `"x"`.
Expression* make_function_name(Checking& c, const Expression& like, std::string_view text);
/// `of.text`
Expression* make_member(Checking& c, Expression* of, std::string_view text);
/// `of[index]`
Expression* make_element(Checking& c, Expression* of, std::int64_t index);
/// Bits of `of`, where `like` stands.
Expression* make_bit(Checking& c, const Expression& like, Expression* of);
/// `of.number`; the text is that of the number.
Expression* make_bit(Checking& c, Expression* of, std::string_view number);
/// `left op right`; `sign` is where the operator is.
Expression* make_binary(Checking& c, Place place, Place sign, Word op, Expression* left,
                        Expression* right);
/// `NOT e`
Expression* make_not(Checking& c, Expression* e);
/// `e^`, where `like` stands, which is of that type.
Expression* make_target(Checking& c, const Expression& like, Expression* e, const Type* type);
/// Where `e` is, as a reference of that type.
Expression* make_reference_to(Checking& c, Expression* e, const Type& type);
/// `e` as a value of `to`, which is not converted yet.
Expression* make_converted(Checking& c, Expression* e, const Type& to);
/// `e` becomes that. Gives the type, which is never null.
const Type* become_converted(Checking& c, Expression*& e, const Type& to);
/// `callee(arguments)`, where `like` stands.
Expression* make_call(Checking& c, const Expression& like, Expression* callee,
                      std::vector<Argument> arguments);
/// The call with other arguments.
Expression* make_with(Checking& c, const Expression& call, std::vector<Argument> arguments);
/// A call of a function of the standard's own sources.
Expression* make_call(Checking& c, std::string_view function, Expression* argument);

/// `target := value;`
Statement* make_assignment(Checking& c, Place place, Expression* target, Expression* value);
/// The statement with another value or call.
Statement* make_with(Checking& c, const Statement& s, Expression* value);
/// `call;`
Statement* make_call_statement(Checking& c, Expression* call);
/// `IF condition THEN then ELSE otherwise END_IF`
Statement* make_if(Checking& c, Place place, Expression* condition, Block then, Block otherwise);
Statement* make_exit(Checking& c, Place place);
/// One behind the other.
Statement* make_sequence(Checking& c, Place place, Block statements);

/// A number without a type of its own takes one: a literal is noted as one of it. Gives it back.
const Type* take_type(Checking& c, Expression*& number, const Type& type, Constant value);

}  // namespace lineshaft::st

#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

bool is_constant(const Expression& expression) {
    return expression.kind == E::constant && expression.type;
}

double as_real(const Expression& constant) {
    return constant.type->is_real() ? constant.constant.real
                                    : static_cast<double>(constant.constant.integer);
}

Expression* make(Checking& c, Expression::Kind kind, const Expression& like) {
    Expression& made = c.tree.expressions.emplace_back();
    made.kind = kind;
    made.token = like.token;
    made.place = like.place;
    return &made;
}

Expression* make_copy(Checking& c, const Expression& e) {
    return &c.tree.expressions.emplace_back(e);
}

Expression* make_constant(Checking& c, const Expression& like, const Type& type, Constant value) {
    Expression* made = make(c, E::constant, like);
    made->type = &type;
    made->constant = std::move(value);
    return made;
}

Expression* make_boolean(Checking& c, const Expression& like, bool value) {
    return make_constant(c, like, bool_type, {.integer = value});
}

Expression* make_name(Checking& c, const Expression& like, std::string_view text) {
    Expression* made = make(c, E::name, like);
    made->token.text = text;
    return made;
}

Expression* make_member(Checking& c, Expression* of, std::string_view text) {
    Expression* made = make(c, E::member, *of);
    made->token.text = text;
    made->operands[0] = of;
    return made;
}

Expression* make_element(Checking& c, Expression* of, std::int64_t index) {
    Expression* made = make(c, E::index, *of);
    made->operands[0] = of;
    made->arguments.push_back({.value = make_constant(c, *of, lint_type, {.integer = index})});
    return made;
}

Expression* make_bit(Checking& c, const Expression& like, Expression* of) {
    Expression* made = make(c, E::bit, like);
    made->operands[0] = of;
    return made;
}

Expression* make_bit(Checking& c, Expression* of, std::string_view number) {
    Expression* made = make_bit(c, *of, of);
    made->token.word = Word::integer;
    made->token.text = number;
    return made;
}

Expression* make_binary(Checking& c, const Expression& like, Place at, Word op, Expression* left,
                        Expression* right) {
    Expression* made = make(c, E::binary, like);
    made->token.place = at;
    made->op = op;
    made->operands[0] = left;
    made->operands[1] = right;
    return made;
}

Expression* make_converted(Checking& c, Expression* e, const Type& to) {
    Expression* made = make(c, E::converted, *e);
    made->operands[0] = e;
    made->type = &to;
    return made;
}

Expression* make_call(Checking& c, const Expression& like, Expression* callee,
                      std::vector<Argument> arguments) {
    Expression* made = make(c, E::call, like);
    made->operands[0] = callee;
    made->arguments = std::move(arguments);
    return made;
}

Expression* make_with(Checking& c, const Expression& call, std::vector<Argument> arguments) {
    Expression* made = make_copy(c, call);
    made->arguments = std::move(arguments);
    return made;
}

Expression* make_call(Checking& c, std::string_view function, Expression* argument) {
    return make_call(c, *argument, make_name(c, *argument, function), {{.value = argument}});
}

Statement* make_assignment(Checking& c, Place place, Expression* target, Expression* value) {
    Statement& made = c.tree.statements.emplace_back();
    made.place = place;
    made.target = target;
    made.value = value;
    return &made;
}

Statement* make_with(Checking& c, const Statement& s, Expression* value) {
    Statement& made = c.tree.statements.emplace_back(s);
    made.value = value;
    return &made;
}

Statement* make_call_statement(Checking& c, Expression* call) {
    Statement& made = c.tree.statements.emplace_back();
    made.kind = S::call;
    made.place = call->place;
    made.value = call;
    return &made;
}

Statement* make_if(Checking& c, Place place, Expression* condition, Block then, Block otherwise) {
    Statement& made = c.tree.statements.emplace_back();
    made.kind = S::if_;
    made.place = place;
    made.branches.push_back({.condition = condition, .body = std::move(then)});
    made.body = std::move(otherwise);
    return &made;
}

Statement* make_sequence(Checking& c, Place place, Block statements) {
    Statement& made = c.tree.statements.emplace_back();
    made.kind = S::sequence;
    made.place = place;
    made.body = std::move(statements);
    return &made;
}

void take_type(Checking& c, Expression*& number, const Type& type, Constant value) {
    if (number->kind != E::constant || !number->type->is_any())
        return (void)(number = make_constant(c, *number, type, std::move(value)));
    number->type = &type;
    number->constant = std::move(value);
}

void become(Expression& e, const Type& type, Constant value) {
    e.kind = E::constant;
    e.type = &type;
    e.constant = std::move(value);
}

}  // namespace lineshaft::st

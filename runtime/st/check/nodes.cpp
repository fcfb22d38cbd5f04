#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

Expression* keep(Checking& c, Expression made) {
    return &c.tree.expressions.emplace_back(std::move(made));
}

Statement* keep(Checking& c, Statement made) {
    return &c.tree.statements.emplace_back(std::move(made));
}

Token with_text(Token token, std::string_view text) {
    token.text = text;
    return token;
}

}  // namespace

bool is_constant(const Expression& expression) {
    return expression.kind == E::constant && expression.type;
}

double as_real(const Expression& constant) {
    return constant.type->is_real() ? constant.constant.real
                                    : static_cast<double>(constant.constant.integer);
}

Expression* make(Checking& c, Expression::Kind kind, const Expression& like) {
    return keep(c, {.kind = kind, .token = like.token, .place = like.place});
}

Expression* make_copy(Checking& c, const Expression& e) {
    return keep(c, Expression(e));
}

Block make_copies(Checking& c, const Block& statements) {
    Block made;
    for (const Statement* s : statements) {
        Statement* copy = keep(c, Statement(*s));
        if (c.beginnings.contains(s)) c.beginnings.insert(copy);
        if (c.renewals.contains(s)) c.renewals.insert(copy);
        copy->body = make_copies(c, s->body);
        for (Branch& branch : copy->branches) branch.body = make_copies(c, branch.body);
        made.push_back(copy);
    }
    return made;
}

Expression* make_constant(Checking& c, const Expression& like, const Type& type, Constant value) {
    return keep(
        c, {.token = like.token, .place = like.place, .type = &type, .constant = std::move(value)});
}

const Type* become(Checking& c, Expression*& e, const Type& type, Constant value) {
    e = make_constant(c, *e, type, std::move(value));
    return &type;
}

Expression* make_boolean(Checking& c, const Expression& like, bool value) {
    return make_constant(c, like, bool_type, {.integer = value});
}

Expression* make_dint(Checking& c, const Expression& like, std::int64_t value) {
    return make_constant(c, like, dint_type, {.integer = value});
}

Expression* make_text(Checking& c, const Expression& quoted) {
    Token token = quoted.token;
    token.word = Word::text;
    return keep(c, {.token = token, .place = quoted.place});
}

Expression* make_use(Checking& c, const Expression& like, Variable& variable) {
    Expression* made = make(c, E::name, like);
    made->type = variable.type;
    made->variable = &variable;
    return made;
}

Expression* make_name(Checking& c, const Expression& like, std::string_view text) {
    return keep(c, {.kind = E::name, .token = with_text(like.token, text), .place = like.place});
}

Expression* make_function_name(Checking& c, const Expression& like, std::string_view text) {
    Expression* made = make_name(c, like, text);
    made->token.local = made->token.quoted = false;
    return made;
}

Expression* make_member(Checking& c, Expression* of, std::string_view text) {
    return keep(c, {.kind = E::member,
                    .token = with_text(of->token, text),
                    .place = of->place,
                    .operands = {of}});
}

Expression* make_element(Checking& c, Expression* of, std::int64_t index) {
    Expression* value = make_constant(c, *of, lint_type, {.integer = index});
    return keep(c, {.kind = E::index,
                    .token = of->token,
                    .place = of->place,
                    .operands = {of},
                    .arguments = {{.value = value}}});
}

Expression* make_bit(Checking& c, const Expression& like, Expression* of) {
    return keep(c, {.kind = E::bit, .token = like.token, .place = like.place, .operands = {of}});
}

Expression* make_bit(Checking& c, Expression* of, std::string_view number) {
    const Token token{.word = Word::integer, .place = of->place, .text = number};
    return keep(c, {.kind = E::bit, .token = token, .place = of->place, .operands = {of}});
}

Expression* make_binary(Checking& c, Place place, Place sign, Word op, Expression* left,
                        Expression* right) {
    return keep(c, {.kind = E::binary,
                    .op = op,
                    .token = {.place = sign},
                    .place = place,
                    .operands = {left, right}});
}

Expression* make_not(Checking& c, Expression* e) {
    Expression* made = make(c, E::unary, *e);
    made->op = Word::not_;
    made->operands[0] = e;
    return made;
}

Expression* make_target(Checking& c, const Expression& like, Expression* e, const Type* type) {
    Expression* made = make(c, E::deref, like);
    made->operands[0] = e;
    made->type = type;
    return made;
}

Expression* make_reference_to(Checking& c, Expression* e, const Type& type) {
    Expression* made = make(c, E::refer, *e);
    made->operands[0] = e;
    made->type = &type;
    c.checked.has_references = true;
    return made;
}

Expression* make_converted(Checking& c, Expression* e, const Type& to) {
    Expression* made = make(c, E::converted, *e);
    made->operands[0] = e;
    made->type = &to;
    return made;
}

const Type* become_converted(Checking& c, Expression*& e, const Type& to) {
    e = make_converted(c, e, to);
    return &to;
}

Expression* make_call(Checking& c, const Expression& like, Expression* callee,
                      std::vector<Argument> arguments) {
    return keep(c, {.kind = E::call,
                    .token = like.token,
                    .place = like.place,
                    .operands = {callee},
                    .arguments = std::move(arguments)});
}

Expression* make_call(Checking& c, std::string_view function, Expression* argument) {
    return make_call(c, *argument, make_function_name(c, *argument, function),
                     {{.value = argument}});
}

Expression* make_with(Checking& c, const Expression& call, std::vector<Argument> arguments) {
    Expression* made = make_copy(c, call);
    made->arguments = std::move(arguments);
    return made;
}

Statement* make_assignment(Checking& c, Place place, Expression* target, Expression* value) {
    return keep(c, {.place = place, .target = target, .value = value});
}

Statement* make_with(Checking& c, const Statement& s, Expression* value) {
    return keep(c,
                {.kind = s.kind, .op = s.op, .place = s.place, .target = s.target, .value = value});
}

Statement* make_call_statement(Checking& c, Expression* call) {
    return keep(c, {.kind = S::call, .place = call->place, .value = call});
}

Statement* make_if(Checking& c, Place place, Expression* condition, Block then, Block otherwise) {
    return keep(c, {.kind = S::if_,
                    .place = place,
                    .branches = {{.condition = condition, .body = std::move(then)}},
                    .body = std::move(otherwise)});
}

Statement* make_exit(Checking& c, Place place) {
    return keep(c, {.kind = S::exit, .place = place});
}

Statement* make_sequence(Checking& c, Place place, Block statements) {
    return keep(c, {.kind = S::sequence, .place = place, .body = std::move(statements)});
}

const Type* take_type(Checking& c, Expression*& number, const Type& type, Constant value) {
    if (number->kind != E::constant || !number->type->is_any())
        return become(c, number, type, std::move(value));
    number->type = &type;
    number->constant = std::move(value);
    return &type;
}

}  // namespace lineshaft::st

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

void become(Expression& e, const Type& type, Constant value) {
    e.kind = E::constant;
    e.type = &type;
    e.constant = std::move(value);
}

void become_boolean(Expression& e, bool value) {
    become(e, bool_type, {.integer = value});
}

Expression* make_call(Checking& c, std::string_view function, Expression* argument) {
    Expression* call = make(c, E::call, *argument);
    call->operands[0] = make(c, E::name, *argument);
    call->operands[0]->token.text = function;
    call->arguments.push_back({.value = argument});
    return call;
}

}  // namespace lineshaft::st

#include "runtime/st/check/time_operators.hpp"

#include "runtime/st/check/constants.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

/// DATE - DATE, TOD - TOD and DT - DT are a TIME; one is added to a TOD and a DT, on either side.
const Type* check_date_arithmetic(Checking& c, Expression& e) {
    if (e.op == Word::plus && e.operands[0]->type->kind == Kind::time)
        std::swap(e.operands[0], e.operands[1]);
    const Type &a = *e.operands[0]->type, &b = *e.operands[1]->type;
    const bool joins = e.op == Word::plus && a.kind == Kind::date && b.kind == Kind::clock;
    const bool distance = e.op == Word::minus && same_type(a, b);
    const bool moves = (e.op == Word::plus || e.op == Word::minus) && b.kind == Kind::time &&
                       (a.kind == Kind::clock || a.kind == Kind::moment);
    if (!distance && !moves && !joins)
        return c.fail(
            "L0905", e.token.place,
            fmt::format("'{}' does not go with {} and {}", shown(e.op), describe(a), describe(b)),
            "a TIME is added to a TOD or a DT, and two dates have a TIME between them");
    const bool within_day = moves && a.kind == Kind::clock;
    e.type = distance ? &time_type : joins || within_day ? &moment_type : &a;
    fold(c, e);
    if (!within_day) return e.type;
    if (!is_constant(e)) return convert_result(c, e, moment_type, clock_type);
    constexpr Wide day = 86'400'000'000'000;
    become(e, clock_type, {.integer = (e.constant.integer % day + day) % day});
    return &clock_type;
}

}  // namespace

void become_moments(Checking& c, Expression& e) {
    for (Expression*& operand : e.operands)
        if (is_dtl(*operand->type)) check(c, *(operand = make_call(c, "DTL_TO_LDT", operand)));
}

const Type* check_time_arithmetic(Checking& c, Expression& e) {
    Expression *&left = e.operands[0], *&right = e.operands[1];
    if (left->type->is_date() || right->type->is_date()) return check_date_arithmetic(c, e);
    const bool both = left->type->kind == Kind::time && right->type->kind == Kind::time;
    const bool adds = e.op == Word::plus || e.op == Word::minus || e.op == Word::mod_;
    Expression*& number = left->type->kind == Kind::time ? right : left;
    const bool scales = !both && number->type->is_number() &&
                        (e.op == Word::times || (e.op == Word::divided && &number == &right));
    if (!(both && adds) && !scales)
        return c.fail("L0905", e.token.place,
                      fmt::format("'{}' does not go with {} and {}", shown(e.op),
                                  describe(*left->type), describe(*right->type)),
                      "times are added and subtracted, and multiplied or divided by a number; "
                      "TIME_TO_LREAL gives a number of ms");
    if (scales) {
        const Type& to = number->type->is_real() ? lreal_type : lint_type;
        const bool is_long = number->type->is_unsigned_64();
        if (!is_long && !coerce(c, number, to)) return nullptr;
    }
    e.type = &time_type;
    fold(c, e);
    return e.type;
}

const Type* check_dtl_arithmetic(Checking& c, Expression& e) {
    become_moments(c, e);
    const Type* type = check_time_arithmetic(c, e);
    if (!type || type->kind != Kind::moment) return type;
    Expression* moved = make(c, e.kind, e);
    *moved = e;
    moved->type = type;
    e = *make_call(c, "LDT_TO_DTL", moved);
    return check(c, e);
}

}  // namespace lineshaft::st

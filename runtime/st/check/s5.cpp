#include "runtime/st/check/s5.hpp"

#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/types/elementary.hpp"
#include "runtime/st/types/s5.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

bool has_instructions(const Place& place) {
    return place.source && place.dialect().has_s7_instructions;
}

/// `Siemens.Step7.s5TimerState(e)`. False: nothing makes it run, and this was told.
bool call_of_s5(Checking& c, Expression*& e, const Type& type, std::string_view what) {
    const bool is_timer = &type == &timer_type;
    const std::string full =
        fmt::format("{}.s5{}{}", siemens_step7, is_timer ? "Timer" : "Counter", what);
    if (!find_in(c.users.routines, full))
        return c.fail(code::not_declared, e->place,
                      fmt::format("nothing here makes the {} '{}' run",
                                  is_timer ? "timer" : "counter", e->place.text()),
                      is_timer ? "start it with S_ODT or another one of these"
                               : "count with S_CU, S_CD or S_CUD");
    Expression* callee = make_function_name(c, *e, c.checked.names.emplace_back(full));
    e = make_call(c, *e, callee, {{.value = e}});
    return true;
}

}  // namespace

std::optional<const Type*> check_s5_name(Checking& c, Expression*& e, const Type* expected) {
    const Token& token = e->token;
    if (!has_instructions(token.place) || token.quoted || token.local) return {};
    const auto object = read_s5_number(token.text);
    if (!object) return {};
    e = make_constant(c, *e, *object->type, {.integer = object->number});
    return signal_of_s5(c, e, *object->type, expected);
}

const Type* signal_of_s5(Checking& c, Expression*& e, const Type& type, const Type* expected) {
    const bool is_number = expected && (expected->is_integer() || expected->is_bits());
    if (is_number || !has_instructions(e->place)) return &type;
    return call_of_s5(c, e, type, "State") ? check(c, e) : nullptr;
}

bool rewrite_s5_reset(Checking& c, Statement*& s) {
    Expression* target = s->target;
    if (s->op != Word::assign || target->kind != E::name || !has_instructions(target->place))
        return false;
    const Variable* variable = find_variable(c, target->token);
    const auto object = variable || target->token.quoted || target->token.local
                            ? std::nullopt
                            : read_s5_number(target->token.text);
    const Type* type = variable ? variable->type : object ? object->type : nullptr;
    const bool resets = same_name(s->value->token.text, "false");
    if (!is_s5_number(type) || s->value->kind != E::name || !resets) return false;
    if (call_of_s5(c, target, *type, "Reset")) {
        s = make_call_statement(c, target);
        check(c, s);
    }
    return true;
}

bool locate_s5(Checking& c, Variable& variable, const Token& at) {
    const auto object = read_s5_number(at.text.substr(at.text.starts_with('%') ? 1 : 0));
    if (!object || object->type != variable.type)
        return c.fail(
            code::not_declared, at.place,
            fmt::format("'{}' is not a {}", at.text, variable.type->name),
            variable.type == &timer_type ? "write its number: %T1" : "write its number: %C1");
    variable.space = Space::constant;
    variable.value = {.integer = object->number};
    return true;
}

bool coerce_s5time(Checking& c, Expression*& e, const Type& to) {
    const Type& from = *e->type;
    const bool is_made = &to == &s5time_type && from.kind == Kind::time,
               is_read = &from == &s5time_type && to.kind == Kind::time;
    if (!is_made && !is_read) return false;
    const auto word = is_made && is_constant(*e) ? s5time_of(e->constant.integer) : std::nullopt;
    if (word) {
        become(c, e, to, {.integer = *word});
        return true;
    }
    const std::string_view function = is_made ? "TIME_TO_S5TIME" : "S5TIME_TO_TIME";
    if (!find_in(c.prelude.routines, function)) return false;
    e = make_call(c, function, e);
    return check(c, e);
}

}  // namespace lineshaft::st

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// Each is compared by instructions of its own.
constexpr Wide most_parts = 4096;

bool is_whole(const Type& type) {
    return type.kind == Kind::integer || type.kind == Kind::bits || type.kind == Kind::boolean;
}

/// `"text"` is a text where it names nothing.
void become_text(Checking& c, Expression*& e) {
    if (e->kind != E::name || !e->token.quoted || find_variable(c, e->token)) return;
    e = make_text(c, *e);
}

/// Their number, and the message.
bool check_test_arguments(Checking& c, Expression& call, const TestStatement& known) {
    const auto values = static_cast<std::size_t>(known.values), count = call.arguments.size();
    const auto refuse = [&](Place place, std::string message, std::string help = {}) {
        return c.fail(code::wrong_arguments, place, std::move(message), std::move(help));
    };
    if (count < values || count > values + (known.has_message ? 1 : 0))
        return refuse(
            call.operands[0]->place,
            fmt::format("{} takes {} argument{}{}", known.name, values, values == 1 ? "" : "s",
                        known.has_message ? " and an optional message" : ""));
    for (const Argument& argument : call.arguments)
        if (argument.name.word != Word::end_of_file)
            return refuse(argument.name.place,
                          fmt::format("the arguments of {} have no names", known.name),
                          "leave the name out");
    for (Argument& argument : call.arguments) become_text(c, argument.value);
    if (count == values) return true;
    Expression*& message = call.arguments.back().value;
    const Type* type = check(c, message, &string_type);
    if (type && type->kind != Kind::text)
        c.fail(code::type_does_not_fit, message->place,
               fmt::format("the message of {} is a STRING, not {}", known.name, describe(*type)));
    return type && type->kind == Kind::text;
}

/// A condition, or a duration.
void check_single(Checking& c, Expression& call) {
    Expression*& value = call.arguments[0].value;
    const bool is_time = call.test == TestCall::advance_time;
    const Type* given = check(c, value, is_time ? &time_type : &bool_type);
    if (!given) return;
    if (given->is_any() && !given->is_real()) coerce(c, value, lint_type);
    const Type& type = *value->type;
    if (is_time ? type.kind == Kind::time || type.kind == Kind::integer : is_whole(type)) return;
    c.fail(code::type_does_not_fit, value->place,
           fmt::format("{} takes {}, not {}", info(call.test).name,
                       is_time ? "a TIME, or a whole number of ns" : "a BOOL", describe(*given)),
           is_time ? "write it as in T#20ms" : "");
}

void check_mocked(Checking& c, Expression& call) {
    Expression*& slot = call.arguments[0].value;
    const Expression& instance = *slot;
    const TestStatement& known = info(call.test);
    if (instance.kind == E::name && !find_variable(c, instance.token)) {
        const Routine* routine = c.find_routine(instance.token);
        if (routine && routine->is_function())
            return void(c.fail(
                code::type_does_not_fit, instance.place,
                fmt::format("{} takes an instance of a function block, and '{}' is a function",
                            known.name, instance.token.text),
                "MOCK_FUNCTION replaces a function; its calls are not counted"));
        if (routine || standard_type(c, instance.token.text))
            return void(c.fail(code::type_does_not_fit, instance.place,
                               fmt::format("{} takes an instance, and '{}' is a kind of block",
                                           known.name, instance.token.text),
                               "name the variable"));
    }
    const Type* type = check(c, slot);
    if (!type) return;
    if (!is_place(*slot) || !type->is_instance())
        c.fail(code::type_does_not_fit, instance.place,
               fmt::format("{} takes an instance of a function block, not {}", known.name,
                           describe(*type)),
               "MOCK_FUNCTION replaces a function");
    if (known.values == 2 && check(c, call.arguments[1].value, &lint_type))
        coerce(c, call.arguments[1].value, lint_type);
}

/// Numbers of any two types are compared by value, a BOOL as 0 or 1, a time by its nanoseconds.
bool check_compared(Checking& c, Expression& call) {
    const TestStatement& known = info(call.test);
    Expression *&a = call.arguments[0].value, *&b = call.arguments[1].value;
    if (a->kind == E::name && (a->token.quoted || !find_variable(c, a->token))) check(c, b);
    const Type* first = check(c, a, b->type);
    const Type* second = check(c, b, first);
    if (!first || !second) return false;
    if (first->kind == Kind::interface || second->kind == Kind::interface) {
        Expression*& other = first->kind == Kind::interface ? b : a;
        return other->type->kind == Kind::interface ||
               coerce(c, other, first->kind == Kind::interface ? *first : *second);
    }
    unite_texts(c, a, b);
    first = a->type, second = b->type;
    const bool parts =
        first->kind == Kind::array || first->kind == Kind::structure || first->kind == Kind::union_;
    const auto refuse = [&](std::string help) {
        return c.fail(code::type_does_not_fit, call.place,
                      fmt::format("{} does not go with {} and {}", known.name, describe(*first),
                                  describe(*second)),
                      std::move(help));
    };
    if (first->kind == Kind::text && second->kind == Kind::text) return true;
    if (parts && count_parts(*first) > most_parts)
        return refuse("these are more than 4096 parts: compare them in a FOR loop");
    if (parts && call.test == TestCall::assert_eq && same_type(*first, *second) && is_place(*a) &&
        is_place(*b))
        return true;
    if (parts && same_type(*first, *second))
        return refuse(call.test == TestCall::assert_eq ? "assign the value to a variable first"
                                                       : "compare its parts one by one");
    if (!first->is_scalar() || !second->is_scalar()) return refuse("");
    const bool enumerations = first->kind == Kind::enumeration && second->kind == Kind::enumeration;
    if (enumerations && first->values != second->values) return refuse("");
    const bool one_is_time = (first->kind == Kind::time) != (second->kind == Kind::time);
    if (one_is_time && (first->is_real() || second->is_real()))
        return refuse("write a time with its unit: T#500ms");
    if (!make_concrete(c, a, *second) || !make_concrete(c, b, *a->type)) return false;
    if (enumerations) return true;
    const bool real = a->type->is_real() || b->type->is_real();
    for (Expression** operand : {&a, &b})
        if ((real && !(*operand)->type->is_real()) || (*operand)->type->kind == Kind::enumeration)
            convert(c, *operand, real ? lreal_type : lint_type);
    return true;
}

bool check_distance(Checking& c, Expression& call) {
    const Type* like = nullptr;
    for (int i = 0; i < 3; ++i) {
        Expression*& value = call.arguments[static_cast<std::size_t>(i)].value;
        const Type* type = check(c, value, like);
        if (!type) return false;
        if (!type->is_number() && type->kind != Kind::time)
            return c.fail(code::type_does_not_fit, value->place,
                          fmt::format("ASSERT_NEAR takes numbers, not {}", describe(*type)));
        if (!like && !type->is_any()) like = type;
    }
    for (int i = 0; i < 3; ++i)
        if (!make_concrete(c, call.arguments[static_cast<std::size_t>(i)].value,
                           like && like->is_real() ? *like : lreal_type))
            return false;
    return true;
}

/// Two variables that the function looks at: whether it is replaced, and its value then.
void add_mock(Checking& c, Routine& function) {
    for (const Type* type : {&bool_type, function.result->type}) {
        Variable& variable = c.make_variable({}, {}, type);
        keep_once(c, variable);
        (type == &bool_type && !function.mock_flag ? function.mock_flag : function.mock_value) =
            &variable;
    }
}

void check_mock_function(Checking& c, Expression& call) {
    const Expression& name = *call.arguments[0].value;
    Routine* const named = name.kind == E::name ? c.find_routine(name.token) : nullptr;
    if (!named && c.tree.lost.contains(name.token.text)) return;
    if (!named || !named->is_function() || !named->result) {
        const bool standard = find_standard_function(name.token.text) != nullptr;
        c.fail(code::not_declared, name.place,
               fmt::format("'{}' is not a FUNCTION of the sources that has a value",
                           name.place.text()),
               standard               ? "call it in a FUNCTION of your own, and replace that"
               : name.kind == E::call ? "write its name alone: the value is that of every call"
                                      : "");
        return;
    }
    Routine& function = *named;
    const Type* type = function.result->type;
    if (!type) return;
    Expression*& value = call.arguments[1].value;
    if (check(c, value, type)) coerce(c, value, *type);
    if (!function.mock_flag) add_mock(c, function);
    call.routine = &function;
}

}  // namespace

bool is_place(const Expression& e) {
    return e.kind == E::name || e.kind == E::member || e.kind == E::index || e.kind == E::deref;
}

const Type* check_test_statement(Checking& c, Expression& call, bool as_statement) {
    const Token& name = call.operands[0]->token;
    const TestCall which = find_test_statement(name.text);
    const TestStatement& known = info(which);
    const bool is_others = !same_name(known.name, call.operands[0]->place.text());
    const bool anywhere = which == TestCall::advance_time || is_others;
    if (!(anywhere && c.has_tests) && !is_library(name) && !c.is_in_test())
        return c.fail(code::wrong_place, name.place,
                      fmt::format("{} stands outside of a TEST", known.name),
                      "only TEST, SETUP and TEARDOWN have it");
    if (!as_statement)
        return c.fail(code::type_does_not_fit, call.place,
                      fmt::format("{} has no value", known.name),
                      "write it as a statement of its own");
    if (!check_test_arguments(c, call, known)) return nullptr;
    call.test = which;
    switch (which) {
        case TestCall::assert_true:
        case TestCall::assert_false:
        case TestCall::advance_time:
            check_single(c, call);
            return nullptr;
        case TestCall::assert_near:
            check_distance(c, call);
            return nullptr;
        case TestCall::mock_function:
            check_mock_function(c, call);
            return nullptr;
        case TestCall::mock:
        case TestCall::mock_verify_called:
        case TestCall::mock_verify_call_count:
            check_mocked(c, call);
            return nullptr;
        case TestCall::none:
        case TestCall::assert_eq:
        case TestCall::assert_neq:
        case TestCall::assert_gt:
        case TestCall::assert_lt:
        case TestCall::assert_ge:
        case TestCall::assert_le:
            break;
    }
    check_compared(c, call);
    return nullptr;
}

}  // namespace lineshaft::st

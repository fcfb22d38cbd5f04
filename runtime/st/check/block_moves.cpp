#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

bool is_element(const Expression& e) {
    return e.kind == E::index && !e.is_character();
}

/// A counter that nobody can name.
Variable& counter(Checking& c) {
    constexpr std::string_view name = "%moved";
    Routine& routine = *c.routine;
    if (Variable* known = find_in(routine.names, name)) return *known;
    Variable& variable = c.make_variable(routine, routine.pou->name, name, &lint_type);
    variable.section = Section::temp;
    routine.names.emplace(name, &variable);
    return variable;
}

/// `FOR i := 0 TO count - 1 DO ADR(to)[i] := value; END_FOR`
Statement* fill(Checking& c, const Statement& s, Expression* value, Expression* count,
                Expression* to) {
    Variable& i = counter(c);
    Expression* element = make(c, E::index, *to);
    element->operands[0] = make_call(c, "ADR", to);
    element->arguments.push_back({.value = make_use(c, *to, i)});
    Statement* loop = make_with(c, s, make_constant(c, *to, lint_type, {}));
    loop->kind = S::for_;
    loop->target = make_use(c, *to, i);
    loop->limit = make_binary(c, s.place, s.place, Word::minus, count,
                              make_constant(c, *count, lint_type, {.integer = 1}));
    loop->body = {make_assignment(c, s.place, element, value)};
    return loop;
}

/// `MEMCPY(ADR(to), ADR(from), count * size)`
Statement* move(Checking& c, const Expression& like, Expression* from, Expression* count,
                Expression* to) {
    Expression* size = make_constant(c, *count, lint_type, {.integer = Wide{bytes_of(*to->type)}});
    Expression* bytes = make_binary(c, like.place, like.place, Word::times, count, size);
    return make_call_statement(c, make_call(c, like, make_name(c, like, "MEMCPY"),
                                            {{.value = make_call(c, "ADR", to)},
                                             {.value = make_call(c, "ADR", from)},
                                             {.value = bytes}}));
}

}  // namespace

void rewrite_block_move(Checking& c, Statement*& s) {
    const Expression& call = *s->value;
    Expression *value = call.arguments[0].value, *count = call.arguments[1].value,
               *to = call.arguments[2].value;
    const bool fills = call.standard->name.find("FILL") != std::string_view::npos;
    if (!check(c, to) || !check(c, value, to->type) || !check(c, count)) return;
    if (!is_element(*to) || (!fills && !(is_element(*value) && same_type(*value->type, *to->type))))
        return (void)c.fail(code::type_does_not_fit, s->place,
                            fmt::format("{} does not go with {} and {}", call.standard->name,
                                        describe(*value->type), describe(*to->type)),
                            fills ? "OUT is the first element of an array that is filled"
                                  : "IN and OUT are elements of arrays of one type: a[0]");
    if (!count->type->is_integer() && !count->type->is_bits())
        return (void)c.fail(code::type_does_not_fit, count->place, "COUNT is a whole number");
    become_lint(c, count);
    s = fills ? fill(c, *s, value, count, to) : move(c, call, value, count, to);
    check(c, s);
}

}  // namespace lineshaft::st

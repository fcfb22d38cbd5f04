#include <string>

#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// A real number that nobody can name.
Variable& kept_real(Checking& c, const Type& type) {
    const std::string_view name = type.bits == 32 ? "%kept" : "%kept_long";
    Routine& routine = *c.routine;
    if (Variable* known = find_in(routine.names, name)) return *known;
    Variable& variable = c.make_variable(routine, routine.pou->name, name, &type);
    variable.section = Section::temp;
    routine.names.emplace(name, &variable);
    return variable;
}

bool becomes_whole(const Expression& e, const Type& from) {
    return from.is_real() && (e.type->is_integer() || e.type->is_bits());
}

/// What a whole number is made of in `e`; null where no real number is.
Expression* whole_of_real(Expression& e) {
    if (!e.type) return nullptr;
    if (e.kind == E::call && e.standard && e.arguments.size() == 1)
        return becomes_whole(e, *e.arguments[0].value->type) ? &e : nullptr;
    if (e.kind != E::converted) return nullptr;
    return becomes_whole(e, *e.operands[0]->type) ? &e : whole_of_real(*e.operands[0]);
}

Expression*& real_of(Expression& whole) {
    return whole.kind == E::call ? whole.arguments[0].value : whole.operands[0];
}

/// `ABS(kept - whole) <= 1`, which is FALSE of what is no number.
Expression* is_near(Checking& c, Expression* kept, Expression* whole) {
    Expression* distance =
        make_binary(c, kept->place, kept->place, Word::minus, make_converted(c, kept, lreal_type),
                    make_converted(c, whole, lreal_type));
    return make_binary(c, kept->place, kept->place, Word::less_or_equal,
                       make_call(c, "ABS", distance),
                       make_constant(c, *kept, lreal_type, {.real = 1}));
}

/// `MIN < MAX`
Expression* has_range(Checking& c, const Expression& call) {
    return make_binary(c, call.place, call.place, Word::less, call.arguments[0].value,
                       call.arguments[2].value);
}

}  // namespace

Block assign_and_tell(Checking& c, Statement* s, Expression* told) {
    const Expression* called = s->value;
    check_assignment(c, s);
    Expression* whole = s->value->type ? whole_of_real(*s->value) : nullptr;
    Expression*& real = whole ? real_of(*whole) : s->value;
    if (!real->type || !real->type->is_real())
        return {s, make_assignment(c, s->place, told, make_boolean(c, *called, true))};
    const Type& type = real->type->plain();
    const Expression* scaled = real;
    while (scaled->kind == E::converted) scaled = scaled->operands[0];
    Expression* kept = make_use(c, *called, kept_real(c, type));
    Statement* keeps = make_assignment(c, s->place, kept, real);
    real = kept;
    Expression* holds = whole ? is_near(c, kept, whole) : make_call(c, "IS_VALID", kept);
    if (scaled->standard && scaled->standard->name.ends_with("_X"))
        holds = make_binary(c, s->place, s->place, Word::and_, has_range(c, *scaled), holds);
    return {keeps, make_assignment(c, s->place, told, holds), s};
}

}  // namespace lineshaft::st

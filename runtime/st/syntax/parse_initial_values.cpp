#include "runtime/st/syntax/grammar.hpp"

namespace lineshaft::st {

namespace {

/// Array_Elem_Init : Unsigned_Int '(' Params ')' | Expression
/// What begins with an Unsigned_Int and a '(' is always the first.
Expression* parse_element(Parsing& p) {
    if (!p.is(Word::integer) || p.next().word != Word::open) return parse_expression(p);
    const Level level(p);
    Expression* count = p.make(Expression::Kind::constant, p.take());
    Expression* repeated = p.make(Expression::Kind::repeated, p.take());
    parse_arguments(p, *repeated, Word::close, parse_initial);
    p.add_operand(*repeated, 0, count);
    return repeated;
}

/// A part of Var_Init and Param_Assign: what stands behind the first value of an array; they end
/// where `goes_on` says.
template <class GoesOn>
Expression* parse_more(Parsing& p, Expression* first, GoesOn goes_on) {
    if (!goes_on()) return first;
    Expression* list = p.make(Expression::Kind::list, p.last());
    list->arguments.push_back({{}, false, first, nullptr});
    while (goes_on()) {
        p.take();
        list->arguments.push_back({{}, false, parse_initial(p), nullptr});
        p.grow(*list, *list->arguments.back().value);
    }
    list->place = first->place.to(p.last().place);
    return list;
}

/// Param_Assign : Name ( ':=' | '=>' ) | 'NOT' ? Name '=>' Value | ( Name ':=' ) ? Value
/// Value : Expression | Init
/// What is named without a value is left out. CoDeSys 2.3 has no brackets around an array's values:
/// in `(a := 1, 2, b := 3)` 2 is of a, too. False: nothing more can be read.
bool parse_argument(Parsing& p, Expression& to, Word end, Expression* (*parse_value)(Parsing&)) {
    Argument argument;
    argument.is_negated = p.at_negated_output();
    if (argument.is_negated) p.take();
    if (p.at_argument_name()) {
        argument.name = p.take();
        argument.is_output = p.take().word == Word::output;
        if (p.is(Word::comma) || p.is(end)) return true;
    }
    argument.value = parse_value(p);
    if (parse_value == parse_initial && argument.is_named() && p.source->dialect.is_loose)
        argument.value = parse_more(p, argument.value, [&] {
            return !p.panic && p.is(Word::comma) && !p.at_argument_name(1) && p.next().word != end;
        });
    if (p.panic) return false;
    p.grow(to, *argument.value);
    to.arguments.push_back(argument);
    return true;
}

}  // namespace

/// Init : Array_Init | Struct_Init | Array_Elem_Init
/// Array_Init : '[' Params ']'
/// Struct_Init : '(' Params ')'
/// Their values are Init again. What begins with '[' is an Array_Init; what has parentheses without
/// a name and a ',' is an Expression.
Expression* parse_initial(Parsing& p) {
    const bool is_structure = p.at_structure();
    if (!is_structure && !p.is(Word::open_bracket)) return parse_element(p);
    const Level level(p);
    Expression* list = p.make(Expression::Kind::list, p.take());
    parse_arguments(p, *list, is_structure ? Word::close : Word::close_bracket, parse_initial);
    return list;
}

/// Var_Init : Init ( ',' Init ) *
/// SCL leaves the brackets of an array's values out: `1, 2, 4(0)`.
Expression* parse_initials(Parsing& p) {
    return parse_more(p, parse_initial(p), [&] { return p.is(Word::comma); });
}

/// Params : ( Param_Assign ( ',' Param_Assign ) * ) ?
/// CODESYS and B&R take a ',' behind the last one, too.
void parse_arguments(Parsing& p, Expression& to, Word end, Expression* (*parse_value)(Parsing&)) {
    const Level level(p);
    if (!p.panic && !p.is(end)) {
        do
            if (!parse_argument(p, to, end, parse_value)) return;
        while ((p.accept(Word::comma) && !(p.source->dialect.commas_may_end_lists && p.is(end))) ||
               refuse_semicolon(p));
    }
    to.place = to.place.to(p.here().place);
    if (!expect(p, end)) to.place.end = p.last().place.end;
}

}  // namespace lineshaft::st

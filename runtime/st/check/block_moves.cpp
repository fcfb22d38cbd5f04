#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

Variable& counter(Checking& c, std::string_view name) {
    Routine& routine = *c.routine;
    if (Variable* known = find_in(routine.names, name)) return *known;
    Variable& variable = c.make_variable(routine, routine.pou->name, name, &lint_type);
    variable.section = Section::temp;
    routine.names.emplace(name, &variable);
    return variable;
}

std::optional<Bounds> bounds_of_array(Checking& c, Expression* array) {
    const Type* type = check(c, array);
    if (!type) return {};
    if (type->kind == Kind::array && !type->has_inner)
        return Bounds{make_constant(c, *array, lint_type, {.integer = type->lower}),
                      make_constant(c, *array, lint_type, {.integer = type->upper})};
    if (!type->is_open_array() || type->dimensions != 1) return {};
    const auto bound = [&](std::string_view function) {
        Expression* first = make_constant(c, *array, lint_type, {.integer = 1});
        Expression* made = make_call(c, *array, make_function_name(c, *array, function),
                                     {{.value = array}, {.value = first}});
        check(c, made);
        convert(c, made, lint_type);
        return made;
    };
    return Bounds{bound("LOWER_BOUND"), bound("UPPER_BOUND")};
}

Expression* argument_of(const Expression& call, std::string_view name) {
    const Argument* found = find_called(call.arguments, name, &Argument::name);
    return found ? found->value : nullptr;
}

Expression* elements_from(Checking& c, const Expression& element) {
    if (element.kind != E::index || element.arguments.size() != 1) return nullptr;
    Expression* index = element.arguments[0].value;
    if (has_call(*index) || has_call(*element.operands[0])) return nullptr;
    const auto bounds = bounds_of_array(c, element.operands[0]);
    if (!bounds || !check(c, index) || !(index->type->is_integer() || index->type->is_bits()))
        return nullptr;
    become_lint(c, index);
    Expression* one = make_constant(c, element, lint_type, {.integer = 1});
    return make_binary(c, element.place, element.place, Word::minus,
                       make_binary(c, element.place, element.place, Word::plus, bounds->upper, one),
                       index);
}

Expression* stays_within(Checking& c, const Expression& like, bool fills, Expression* in,
                         Expression* count, Expression* out) {
    if (!in || !count || !out || has_call(*count) || !check(c, count)) return nullptr;
    if (!count->type->is_integer() && !count->type->is_bits()) return nullptr;
    become_lint(c, count);
    Expression* all = nullptr;
    for (Expression* place : {fills ? nullptr : in, out}) {
        Expression* rest = place ? elements_from(c, *place) : nullptr;
        if (!rest) continue;
        Expression* fits = make_binary(c, like.place, like.place, Word::less_or_equal, count, rest);
        all = all ? make_binary(c, like.place, like.place, Word::and_, all, fits) : fits;
    }
    return all;
}

namespace {

/// Also of an ARRAY[*], which is where a pointer is.
bool is_element(const Expression& e) {
    const bool is_of_open = e.kind == E::deref && e.operands[0]->type->is_open_array();
    return is_of_open || (e.kind == E::index && !e.is_character());
}

/// `FOR i := 0 TO count - 1 DO ADR(to)[i] := value; END_FOR`
Statement* fill(Checking& c, const Statement& s, Expression* value, Expression* count,
                Expression* to) {
    Variable& i = counter(c, "%moved");
    Expression* element = make(c, E::index, *to);
    element->operands[0] = make_call(c, "__SYSTEM.ADR", to);
    element->arguments.push_back({.value = make_use(c, *to, i)});
    Statement* loop = make_with(c, s, make_constant(c, *to, lint_type, {}));
    loop->kind = S::for_;
    loop->target = make_use(c, *to, i);
    loop->limit = make_binary(c, s.place, s.place, Word::minus, count,
                              make_constant(c, *count, lint_type, {.integer = 1}));
    loop->body = {make_assignment(c, s.place, element, value)};
    return loop;
}

/// It is a member of a structure all of whose members are of one elementary type.
bool is_alike(const Expression& e) {
    if (e.kind != E::member || !e.variable) return false;
    const Type* of = e.operands[0]->type;
    return of && of->kind == Kind::structure &&
           std::ranges::all_of(of->members, [&](const Variable* member) {
               return member->type && member->type->is_scalar() &&
                      same_type(*member->type, *e.type);
           });
}

/// `moved := count; IF moved > 0 THEN of.first := value; END_IF; IF moved > 1 THEN ...`
Statement* fill_members(Checking& c, const Statement& s, Expression* value, Expression* count,
                        Expression* first) {
    Variable& left = counter(c, "%moved");
    Block made{make_assignment(c, s.place, make_use(c, *first, left), count)};
    const auto& members = first->operands[0]->type->members;
    auto member = std::ranges::find(members, first->variable);
    for (Wide number = 0; member != members.end(); ++member, ++number) {
        Expression* is_due =
            make_binary(c, s.place, s.place, Word::greater, make_use(c, *first, left),
                        make_constant(c, *first, lint_type, {.integer = number}));
        Expression* to = make_member(c, first->operands[0], (*member)->text);
        made.push_back(make_if(c, s.place, is_due, {make_assignment(c, s.place, to, value)}, {}));
    }
    return make_sequence(c, s.place, std::move(made));
}

/// `MEMCPY(ADR(to), ADR(from), count * size)`
Statement* move(Checking& c, const Expression& like, Expression* from, Expression* count,
                Expression* to) {
    Expression* size = make_constant(c, *count, lint_type, {.integer = Wide{bytes_of(*to->type)}});
    Expression* bytes = make_binary(c, like.place, like.place, Word::times, count, size);
    return make_call_statement(c, make_call(c, like, make_name(c, like, "MEMCPY"),
                                            {{.value = make_call(c, "__SYSTEM.ADR", to)},
                                             {.value = make_call(c, "__SYSTEM.ADR", from)},
                                             {.value = bytes}}));
}

}  // namespace

void rewrite_block_move(Checking& c, Statement*& s) {
    const Expression& call = *s->value;
    Expression *value = call.arguments[0].value, *count = call.arguments[1].value,
               *to = call.arguments[2].value;
    const bool fills = call.standard->rewriting == Rewriting::fill_block;
    Expression* fits = stays_within(c, call, fills, value, count, to);
    if (!check(c, to) || !check(c, value, to->type) || !check(c, count)) return;
    const bool fills_members = fills && is_alike(*to);
    if (!(is_element(*to) || fills_members) ||
        (!fills && !(is_element(*value) && same_type(*value->type, *to->type))))
        return (void)c.fail(code::type_does_not_fit, s->place,
                            fmt::format("{} does not go with {} and {}", call.standard->name,
                                        describe(*value->type), describe(*to->type)),
                            fills ? "OUT is the first element that is filled, of an array, or of "
                                    "a structure of one type"
                                  : "IN and OUT are elements of arrays of one type: a[0]");
    if (!count->type->is_integer() && !count->type->is_bits())
        return (void)c.fail(code::type_does_not_fit, count->place, "COUNT is a whole number");
    if (fills_members && !coerce(c, value, *to->type)) return;
    become_lint(c, count);
    Statement* made = fills_members ? fill_members(c, *s, value, count, to)
                      : fills       ? fill(c, *s, value, count, to)
                                    : move(c, call, value, count, to);
    if (fits && !check(c, fits, &bool_type)) return;
    if (fits && is_constant(*fits) && fits->constant.integer == 0)
        c.warn(code::value_out_of_range, s->place,
               fmt::format("{} does nothing: there are fewer elements than COUNT from there on",
                           call.standard->name),
               "take a lesser COUNT, or begin before");
    s = fits ? make_if(c, s->place, fits, {made}, {}) : made;
    check(c, s);
}

void rewrite_demux(Checking& c, Statement*& s) {
    const StandardFunction& f = *s->value->standard;
    Expression* otherwise = argument_of(*s->value, "OUTELSE");
    std::vector<Argument> others;
    std::ranges::copy_if(s->value->arguments, std::back_inserter(others),
                         [&](const Argument& given) { return given.value != otherwise; });
    Expression* call = make_with(c, *s->value, std::move(others));
    if (!check_count(c, *call, f) || !order_arguments(c, call, f)) return;
    Expression *&number = call->arguments[0].value, *in = call->arguments[1].value;
    if (!check(c, number)) return;
    if (!number->type->is_integer() && !number->type->is_bits())
        return (void)c.fail(code::type_does_not_fit, number->place, "K is a whole number");
    become_lint(c, number);
    Variable& chosen = counter(c, "%moved");
    const auto put = [&](Expression* to) {
        return Block{make_assignment(c, s->place, to, make_copy(c, *in))};
    };
    Block rest;
    if (otherwise) rest = put(otherwise);
    for (std::size_t i = call->arguments.size(); i-- > 2;) {
        Expression* place =
            make_constant(c, *call, lint_type, {.integer = static_cast<Wide>(i) - 2});
        Expression* is_this =
            make_binary(c, s->place, s->place, Word::equal, make_use(c, *call, chosen), place);
        rest = {make_if(c, s->place, is_this, put(call->arguments[i].value), std::move(rest))};
    }
    rest.insert(rest.begin(), make_assignment(c, s->place, make_use(c, *call, chosen), number));
    s = make_sequence(c, s->place, std::move(rest));
    check(c, s);
}

}  // namespace lineshaft::st

#include "runtime/st/check/open_arrays.hpp"

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"

namespace lineshaft::st {

std::string bound_name(const Variable& array, bool is_lower, std::size_t dimension) {
    return fmt::format("{}.{}{}", array.text, is_lower ? "lower" : "upper", dimension);
}

Expression* bound_of(Checking& c, const Expression& array, bool is_lower, std::size_t dimension) {
    const std::string_view name =
        c.checked.names.emplace_back(bound_name(*array.variable, is_lower, dimension));
    if (array.kind == E::member) {
        Expression* made = make_copy(c, array);
        made->token.text = name;
        made->variable = find_member(*array.operands[0]->type, name);
        made->type = &lint_type;
        return made;
    }
    Expression* made = make_name(c, array, name);
    check(c, made);
    return made;
}

/// `a` of `REF(a)`; else the expression itself.
static Expression* without_ref(Expression* e) {
    const bool is_ref = e->kind == E::call && e->operands[0]->kind == E::name &&
                        same_name(e->operands[0]->token.text, "ref") && e->arguments.size() == 1;
    return is_ref ? e->arguments[0].value : e;
}

void assign_open_array(Checking& c, Statement*& s) {
    Expression& target = *s->target;
    if (!target.variable || !check_target(c, target)) return;
    if (without_ref(s->value) == s->value) {
        if (!check(c, s->value, target.type)) return;
        if (s->value->type == &null_type) return (void)coerce(c, s->value, *target.type);
    }
    std::vector<Expression*> bounds;
    std::vector<Variable*> variables;
    for (std::size_t i = 0; i < 2 * target.type->dimensions; ++i) {
        bounds.push_back(bound_of(c, target, i % 2 == 0, i / 2));
        variables.push_back(bounds.back()->variable);
    }
    std::vector<Argument> given;
    give_open_array(c, {.value = s->value}, *target.variable, variables, given);
    if (given.empty()) return;
    Block assigned{make_assignment(c, s->place, s->target, given[0].value)};
    for (std::size_t i = 0; i < bounds.size(); ++i)
        assigned.push_back(make_assignment(c, s->place, bounds[i], given[i + 1].value));
    s = make_sequence(c, s->place, std::move(assigned));
}

Expression* moved_in_open_array(Checking& c, const Expression& e) {
    Expression* array = e.operands[0];
    Expression* moved = array;
    for (std::size_t i = 0; i < e.arguments.size(); ++i) {
        moved = make_binary(c, e.place, e.place, Word::plus, moved, e.arguments[i].value);
        moved->type = array->type;
        for (std::size_t dimension = i; dimension < array->type->dimensions; ++dimension)
            for (const bool is_lower : {true, false})
                moved->arguments.push_back({.value = bound_of(c, *array, is_lower, dimension)});
        moved->constant.integer = Wide{bytes_of(*array->type->element)};
    }
    return moved;
}

void give_open_array(Checking& c, const Argument& argument, Variable& array,
                     const std::vector<Variable*>& bounds, std::vector<Argument>& to) {
    Expression* given = without_ref(argument.value);
    const Type& open = *array.type;
    const Type* type = check(c, given);
    if (!type || !open.element) return;
    std::vector<Expression*> values;
    Expression* first = given;
    if (type->is_open_array()) {
        for (std::size_t i = 0; i < 2 * type->dimensions; ++i)
            values.push_back(bound_of(c, *given, i % 2 == 0, i / 2));
        type = type->element;
    }
    const bool is_passed_on = !values.empty();
    while (values.size() < bounds.size() && type && type->kind == Kind::array) {
        for (const std::int64_t bound : {type->lower, type->upper})
            values.push_back(make_constant(c, *given, lint_type, {.integer = bound}));
        first = make_element(c, first, type->lower);
        type = type->element;
    }
    const bool has_dimensions = values.size() == bounds.size() && type;
    if (!has_dimensions || !same_type(*type, *open.element))
        return (void)c.fail(
            code::type_does_not_fit, given->place,
            fmt::format("'{}' is {}, and {} is given", array.text, describe(open),
                        describe(*given->type)),
            has_dimensions && type->kind != Kind::array
                ? fmt::format("give an array whose elements are {}", describe(*open.element))
                : fmt::format("give a variable that is an array of {}",
                              open.dimensions == 1 ? "one dimension" : "as many dimensions"));
    if (is_passed_on)
        first = make_converted(c, given, open);
    else if (!check(c, first) || !refer(c, first, open))
        return;
    to.push_back({argument.name, false, first, &array});
    for (std::size_t i = 0; i < bounds.size(); ++i)
        to.push_back({argument.name, false, values[i], bounds[i]});
}

}  // namespace lineshaft::st

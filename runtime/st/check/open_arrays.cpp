#include "runtime/st/check/open_arrays.hpp"

#include <fmt/format.h>

#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"

namespace lineshaft::st {

std::string bound_name(const Variable& array, bool is_lower, std::size_t dimension) {
    return fmt::format("{}.{}{}", array.text, is_lower ? "lower" : "upper", dimension);
}

Expression* bound_of(Checking& c, const Expression& array, bool is_lower, std::size_t dimension) {
    Expression* made = make_name(
        c, array, c.checked.names.emplace_back(bound_name(*array.variable, is_lower, dimension)));
    check(c, made);
    return made;
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
    Expression* given = argument.value;
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
    if (values.size() != bounds.size() || !type || !same_type(*type, *open.element))
        return (void)c.fail(
            code::type_does_not_fit, given->place,
            fmt::format("'{}' is {}, and {} is given", array.text, describe(open),
                        describe(*given->type)),
            fmt::format("give a variable that is an array of {}",
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

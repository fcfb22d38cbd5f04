#include <fmt/format.h>

#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"

namespace lineshaft::st {

namespace {

Expression like_name(const Variable& variable) {
    return {.token = variable.name, .place = variable.name.place};
}

Expression* typed_use(Checking& c, const Expression& like, Variable& variable) {
    Expression* use = make_use(c, like, variable);
    use->type = variable.type;
    return use;
}

void assign_in_each_call(Checking& c, Routine& routine, Variable& to, Variable& from) {
    const Expression like = like_name(to);
    routine.call_begins.push_back(
        make_assignment(c, like.place, typed_use(c, like, to), typed_use(c, like, from)));
    routine.holds_instance = true;
}

Variable& keep_beside(Checking& c, const Variable& like, std::string text, const Type* type) {
    Variable& made =
        c.make_variable(like.name, c.checked.names.emplace_back(std::move(text)), type);
    made.used = true;
    keep_once(c, made);
    return made;
}

}  // namespace

bool is_its_own_block(const Routine& routine, const Type* type) {
    const bool is_method = routine.owner && !routine.is_test() && !routine.is_prototype();
    return is_method && type && type == routine.owner->type;
}

void begin_anew(Checking& c, Routine& routine, Variable& variable) {
    Variable& fresh =
        keep_beside(c, variable, fmt::format("{} as it begins", variable.text), variable.type);
    fresh.initial = variable.initial;
    fresh.constructed = variable.constructed;
    assign_in_each_call(c, routine, variable, fresh);
}

Variable& take_own_instance(Checking& c, Routine& routine, Variable& input) {
    input.section = Section::in_out;
    input.constant = input.used = true;
    input.space = Space::reference;
    Variable& copy =
        keep_beside(c, input, fmt::format("{}.{}", routine.name, input.text), input.type);
    assign_in_each_call(c, routine, copy, input);
    return copy;
}

void give_own_instance(Checking& c, Routine& routine, Variable& result) {
    Variable& given =
        keep_beside(c, result, fmt::format("{} of {}", result.text, routine.name), result.type);
    begin_anew(c, routine, given);
    result.type = &make_reference(c, Referring::alias, given.type);
    const Expression like = like_name(result);
    Statement* refer =
        make_assignment(c, like.place, typed_use(c, like, result),
                        make_reference_to(c, typed_use(c, like, given), *result.type));
    refer->op = Word::reference_assign;
    routine.call_begins.push_back(refer);
}

}  // namespace lineshaft::st

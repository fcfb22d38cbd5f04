#include <utility>

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"

namespace lineshaft::st {

namespace {

bool is_constant_place(Checking& c, const Expression& place) {
    for (const Argument& index : place.arguments)
        if (index.value->kind != E::constant) return false;
    return !place.operands[0] || is_constant_place(c, *place.operands[0]);
}

/// What stands behind BEGIN of a data block: assignments of constants to its parts.
void check_data_block(Checking& c, const Global& global) {
    if (!global.pou || !global.type) return;
    Routine parts;
    parts.pou = global.pou;
    for (Variable* member : global.type->members) parts.names.emplace(member->text, member);
    if (global.type->kind == Kind::block) parts.names = global.type->routine->names;
    c.routine = &parts;
    for (Statement* s : global.pou->body) {
        if (s->kind != S::assign || s->op != Word::assign) {
            c.fail(code::wrong_place, s->place, "a data block has no code",
                   "assign constants, and write statements in a block");
            continue;
        }
        const Type* type = check(c, s->target);
        if (!is_constant_place(c, *s->target))
            c.fail(code::not_a_constant, s->target->place, "the index is not a constant");
        if (type) check_initial(c, s->value, *type);
    }
    c.routine = nullptr;
}

void check_part(Checking& c, Expression*& value, const Type& type, std::string_view member,
                std::int64_t index = 0) {
    c.beginning.path.emplace_back(member, index);
    check_initial(c, value, type);
    c.beginning.path.pop_back();
}

/// Of several dimensions either a list of lists, or all elements in one, the last index first.
void check_elements(Checking& c, Expression& list, const Type& array) {
    const bool nested = list.is_nested();
    const Type& element = nested ? *array.element : array.innermost();
    Wide room = Wide{array.upper} - array.lower + 1;
    for (const Type* inner = &array; !nested && inner->has_inner; inner = inner->element)
        room *= Wide{inner->element->upper} - inner->element->lower + 1;
    Wide count = 0;
    const bool outer = c.beginning.is_repeated;
    c.beginning.is_repeated |= !nested && array.has_inner;  // one index does not say which
    for (Argument& argument : list.arguments) {
        Expression* value = argument.value;
        if (value->kind != E::repeated) {
            check_part(c, argument.value, element, {},
                       array.lower + static_cast<std::int64_t>(count));
            ++count;
            continue;
        }
        const bool was_repeated = std::exchange(c.beginning.is_repeated, true);
        const auto times = check_whole(c, value->operands[0], lint_type);
        for (Argument& repeated : value->arguments) check_initial(c, repeated.value, element);
        c.beginning.is_repeated = was_repeated;
        const Wide one = static_cast<Wide>(std::max<std::size_t>(value->arguments.size(), 1));
        if (times && *times >= 0 && *times <= most_elements) count += *times * one;
    }
    c.beginning.is_repeated = outer;
    if (count > room)
        c.fail(code::value_out_of_range, list.place,
               fmt::format("{} values for {} elements", static_cast<std::int64_t>(count),
                           static_cast<std::int64_t>(room)),
               "leave some out, or make the array larger");
}

/// By name, or of a structure by position.
void check_members(Checking& c, Expression& list, const Type& type) {
    const bool by_place =
        type.kind == Kind::structure && std::ranges::none_of(list.arguments, &Argument::is_named);
    if (by_place && list.arguments.size() > type.members.size())
        return (void)c.fail(
            code::value_out_of_range, list.place,
            fmt::format("{} values for {} members", list.arguments.size(), type.members.size()),
            "leave some out");
    for (std::size_t i = 0; i < list.arguments.size(); ++i) {
        Argument& argument = list.arguments[i];
        if (!by_place && !argument.is_named()) {
            c.fail(code::type_does_not_fit, argument.value->place, "this value has no name",
                   fmt::format("name the member of {}: (name := value)", describe(type)));
            continue;
        }
        Variable* found = by_place ? type.members[i] : find_member(type, argument.name.text);
        argument.variable = found;
        if (!found)
            c.fail(code::not_declared, argument.name.place,
                   fmt::format("{} has no '{}'", describe(type), argument.name.text),
                   suggest(argument.name.text, names_of(type.members)));
        else if (found->type)
            check_part(c, argument.value, *found->type, found->text);
    }
}

/// `(0)`, which B&R and CODESYS 2.3 write for the initial values of what has several.
bool is_nothing(const Expression& value, const Type& type) {
    const bool has_several =
        type.kind == Kind::structure || type.kind == Kind::array || type.kind == Kind::block;
    return has_several && value.kind == E::constant && value.token.text == "0";
}

}  // namespace

void check_initial_values(Checking& c) {
    const auto check_one = [&](Variable& variable) {
        if (!variable.initial || !variable.type || variable.space == Space::constant) return;
        check_initial(c, variable);
    };
    for (Variable& variable : c.checked.variables) {
        check_one(variable);
        begin_instance(c, variable);
    }
    for (const Global& global : c.checked.globals) check_data_block(c, global);
    for (Routine& routine : c.checked.routines) {
        c.routine = &routine;
        // By index: ADR of a constant adds a variable.
        for (std::size_t i = 0; i < routine.variables.size(); ++i) {
            Variable& variable = routine.variables[i];
            if (variable.initial && variable.section == Section::in_out)
                c.fail(code::wrong_place, variable.name.place, "a VAR_IN_OUT has no initial value",
                       "leave ':= ...' out; the caller gives the variable");
            check_one(variable);
            begin_instance(c, variable);
        }
    }
    c.routine = nullptr;
    begin_globals(c);
}

void check_initial(Checking& c, Variable& variable) {
    Expression& written = *variable.initial;
    if (!written.initial) {
        Expression* value = &written;
        const bool begins = variable.space == Space::global || (c.routine && variable.of);
        const Checking::Beginning own{.variable = begins ? &variable : nullptr};
        Checking::Beginning outer = std::exchange(c.beginning, own);
        check_initial(c, value, *variable.type);
        const bool is_made = std::exchange(c.beginning, std::move(outer)).is_made;
        if (is_made) return void(variable.initial = value);
        written.initial = value;
    }
    variable.initial = written.initial;
}

void check_initial(Checking& c, Expression*& value, const Type& type) {
    if (is_dtl(type) && value->token.word == Word::duration)
        if (!(value = list_of_dtl(c, *value, type))) return;
    if (value->kind == E::list) {
        value->type = &type;
        const bool is_structure = value->is_structure();
        if (type.kind == Kind::array && !is_structure) return check_elements(c, *value, type);
        const bool has_members = type.kind == Kind::structure || type.kind == Kind::union_;
        if ((has_members || type.is_instance()) && is_structure)
            return check_members(c, *value, type);
        c.fail(code::type_does_not_fit, value->place,
               fmt::format("this is not a value of {}", describe(type)),
               type.kind == Kind::array ? "write its elements in brackets: [1, 2, 3]"
               : type.is_real()         ? "write a decimal point: 1.5"
                                        : "");
        return;
    }
    if (value->kind == E::repeated && type.kind == Kind::array) {
        Expression* list = make(c, E::list, *value->operands[0]);
        list->arguments.push_back({.value = value});
        value = list;
        return check_initial(c, value, type);
    }
    if (is_nothing(*value, type)) {
        value = make(c, E::list, *value);
        value->token.word = type.kind == Kind::array ? Word::open_bracket : Word::open;
        return check_initial(c, value, type);
    }
    if (!check(c, value, &type)) return;
    evaluate(c, value);
    if (!coerce(c, value, type)) return;
    if (!evaluate(c, value) && value->type && !begin_with(c, value, type))
        c.fail(code::not_a_constant, value->place, "an initial value is a constant",
               "assign it in the body, behind IF NOT started");
}

}  // namespace lineshaft::st

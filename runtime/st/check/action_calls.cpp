#include <algorithm>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"

namespace lineshaft::st {

namespace {

/// The action that a name alone means; null: there is none.
const Routine* find_action(Checking& c, Expression& name) {
    const auto is_action = [](const Routine* r) { return r && r->pou->is_action; };
    const auto of_block = [&](const Routine& block) -> const Routine* {
        const Routine* found = find_in(block.methods, name.token.text);
        return is_action(found) ? found : nullptr;
    };
    if (name.kind == E::member) {
        const Type* of = check(c, name.operands[0]);
        return of && of->kind == Kind::block ? of_block(*of->routine) : nullptr;
    }
    for (const Routine* r = c.routine; r; r = r->owner)
        if (const Routine* found = of_block(*r)) return found;
    const Routine* beside = c.find_routine(name.token);
    return is_action(beside) ? beside : nullptr;
}

/// The name of a variable or of THIS, with parts or without; that of a namespace is none.
bool is_of_variable(Checking& c, const Expression& e) {
    if (e.kind != E::name) return e.operands[0] && is_of_variable(c, *e.operands[0]);
    return find_variable(c, e.token) || is_own_instance(c, e);
}

bool is_in_out(const Routine& block, const Token& name) {
    return std::ranges::any_of(all_variables(block), [&](const Variable* variable) {
        return variable->section == Section::in_out && same_name(variable->text, name.text);
    });
}

/// CoDeSys 2.3: the name of a PROGRAM or an instance alone is a call of it.
bool is_called_alone(const Type& type, const Place& place) {
    return type.is_instance() && lower(place.source->file->path).ends_with(".exp");
}

}  // namespace

void check_action(Checking& c, Statement*& s) {
    Expression* name = s->value;
    if (name->kind == E::index || name->kind == E::bit || !find_action(c, *name)) {
        Expression* instance = make_copy(c, *name);
        const Type* type = check(c, s->value);
        if (type && is_called_alone(*type, s->place)) {
            s = make_call_statement(c, make_call(c, *name, instance, {}));
            return check(c, s);
        }
        if (type)
            c.warn(code::something_else_expected, s->place, "this does nothing",
                   "write 'name := value;', or a call 'name();'");
        return void(s = make_sequence(c, s->place, {}));
    }
    s = make_call_statement(c, make_call(c, *name, name, {}));
    check(c, s);
}

bool runs_with_pins(Checking& c, Statement*& s) {
    const Expression& call = *s->value;
    const auto is_given = [](const Argument& a) { return a.is_named() && a.value; };
    if (call.kind != E::call || call.arguments.empty() || call.type ||
        !std::ranges::all_of(call.arguments, is_given))
        return false;
    Expression* callee = call.operands[0];
    if (callee->kind == E::member && !is_of_variable(c, *callee->operands[0])) return false;
    if (!find_action(c, *callee)) return false;
    const bool is_of_member = callee->kind == E::member;
    Expression* instance = is_of_member ? callee->operands[0] : make_name(c, *callee, "this");
    const Type* type = is_of_member ? check(c, instance) : nullptr;
    const Routine* block = is_of_member ? type->routine : own_block(c);
    std::vector<Argument> referred;
    Block made, taken;
    for (const Argument& argument : call.arguments) {
        if (block && !argument.is_output && is_in_out(*block, argument.name)) {
            referred.push_back(argument);
            continue;
        }
        Expression* pin = is_of_member
                              ? make_member(c, instance, argument.name.text)
                              : make_name(c, {.token = argument.name, .place = argument.name.place},
                                          argument.name.text);
        const Place place = argument.value->place;
        if (argument.is_output)
            taken.push_back(make_assignment(c, place, argument.value, pin));
        else
            made.push_back(make_assignment(c, place, pin, argument.value));
    }
    Expression* run = make_with(c, call, {});
    if (!referred.empty()) {
        Expression* action = run;
        run = make_call(c, call, instance, std::move(referred));
        run->operands[1] = action;
    }
    made.push_back(make_call_statement(c, run));
    std::ranges::move(taken, std::back_inserter(made));
    s = make_sequence(c, s->place, std::move(made));
    check(c, s);
    return true;
}

}  // namespace lineshaft::st

#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

const Type* object_type(Checking& c, const Type& handle) {
    return standard_type(c, handle.standard->name);
}

Variable* declare_object(Checking& c, Variable& variable) {
    if (variable.type->kind == Kind::handle) variable.type = object_type(c, *variable.type);
    variable.section = Section::global;
    variable.space = Space::global;
    variable.global = static_cast<int>(c.checked.globals.size());
    c.checked.globals.push_back({std::string(variable.text), variable.type, nullptr, &variable});
    c.globals.emplace(variable.text, &variable);
    return &variable;
}

void make_object(Checking& c, Variable& variable) {
    if (!variable.type || !variable.type->is_object()) return;
    Type& own = c.checked.types.emplace_back(*variable.type);
    own.initial_value = variable.initial;
    variable.type = &own;
    variable.space = Space::global;
    variable.global = static_cast<int>(c.checked.globals.size());
    c.checked.globals.push_back({std::string(variable.text), &own});
}

void take_place_of_object(Checking& c, Expression*& e) {
    const bool is_object = e->type && e->type->is_object() && e->kind == E::name && e->variable &&
                           e->variable->global >= 0;
    const Type* handle = is_object ? standard_type(c, e->type->standard->handle) : nullptr;
    if (!handle) return;
    const int global = e->variable->global;
    Variable*& place = c.places_of_objects[global];
    if (!place) {
        place = &c.checked.variables.emplace_back();
        place->name = e->token;
        place->text = c.checked.names.emplace_back(
            fmt::format("\"{}\"", c.checked.globals[static_cast<std::size_t>(global)].name));
        place->type = handle;
        place->named = global;
        place->used = true;
        keep_once(c, *place);
    }
    e = make_use(c, *e, *place);
}

Variable* declare_program(Checking& c, const Token& name) {
    const bool is_plain = name.place.source && !name.quoted && !name.local;
    const Routine* program =
        is_plain && name.place.dialect().programs_are_named ? c.find_routine(name) : nullptr;
    if (!program || program->pou->kind != PouKind::program) return nullptr;
    Variable& variable = c.make_variable(program->pou->name, program->name, program->type);
    declare_object(c, variable);
    c.checked.globals.back().object = nullptr;
    return &variable;
}

const Type* use_object(Checking& c, Expression*& e, const Type& type) {
    Variable& variable = c.make_variable(e->token, e->token.text, &type);
    declare_object(c, variable);
    return use(c, e, variable);
}

Routine* find_part(Checking& c, const Type& type, std::string_view name) {
    if (type.kind != Kind::handle && !type.is_object()) return nullptr;
    const std::string part = fmt::format("{}.{}", type.standard->handle, name);
    Routine* own = find_in(c.prelude.routines, part);
    return own ? own : c.find_in_libraries(c.users.routines, part);
}

namespace {

bool is_pin_of_an_axis(std::string_view pin) {
    return same_name(pin, "axis") || same_name(pin, "master") || same_name(pin, "slave");
}

/// `Axis := x` in a call that may stand behind this name, of an axis that is declared nowhere.
bool is_given_to_a_pin(Checking& c, const Token& name) {
    if (name.local || c.is_in_test()) return false;
    if (!c.given_axes) {
        c.given_axes.emplace();
        for (const Expression& call : c.tree.expressions) {
            if (call.kind != E::call) continue;
            for (const Argument& given : call.arguments)
                if (given.value && given.value->kind == E::name &&
                    is_pin_of_an_axis(given.name.text))
                    c.given_axes->emplace(given.value->token.text, true);
        }
        for (const Declaration& declared : c.tree.declarations)
            c.given_axes->erase(declared.name.text);
    }
    return c.given_axes->contains(name.text);
}

}  // namespace

bool hides_object(const Token& quoted, const Variable& found) {
    const bool is_global = found.space == Space::global || found.space == Space::constant;
    const bool is_handle = found.type && found.type->kind == Kind::handle;
    const bool is_scl = quoted.place.source && quoted.place.dialect().has_s7_instructions;
    return quoted.quoted && is_scl && !is_global && !is_handle;
}

bool is_object_of(Checking& c, const Expression& member) {
    const Expression& of = *member.operands[0];
    if (of.kind != E::name || of.type) return false;
    const Variable* found = find_variable(c, of.token);
    const bool is_hidden = found && found->type && hides_object(of.token, *found) &&
                           !find_member(*found->type, member.token.text);
    if ((found && !is_hidden) || c.find_routine(of.token)) return false;
    if (!of.token.quoted && !is_given_to_a_pin(c, of.token)) return false;
    const Type* axis = standard_type(c, technology_object);
    if (!axis || enumeration_of(c, member)) return false;
    return find_part(c, *axis, member.token.text) ||
           find_member(*object_type(c, *axis), member.token.text);
}

const Type* check_part(Checking& c, Expression*& member, Routine& part) {
    Expression* callee = make(c, E::name, *member);
    member = make_call(c, *member, callee, {{.value = member->operands[0]}});
    return check_routine_call(c, member, part, false);
}

}  // namespace lineshaft::st

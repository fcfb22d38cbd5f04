#include "runtime/st/check/declarations.hpp"

#include "runtime/source/codes.hpp"
#include "runtime/source/units.hpp"
#include "runtime/st/check/catalog_types.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/initial_values.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/objects.hpp"
#include "runtime/st/check/order.hpp"
#include "runtime/st/check/types.hpp"

namespace lineshaft::st {

namespace {

void check_unit(Checking& c, Variable& variable, const Declaration& declared) {
    if (declared.unit.empty()) return;
    variable.unit = declared.unit;
    if (!Unit::parse(variable.unit))
        c.fail(code::unknown_unit, declared.unit_place,
               fmt::format("'{}' is not a unit", declared.unit), "lineshaft units lists them");
}

/// All that stands in VAR_GLOBAL.
Type& global_variables(Checking& c) {
    if (c.checked.globals.empty())
        c.checked.globals.push_back({"globals", &c.make_type(Kind::structure, "globals")});
    return const_cast<Type&>(*c.checked.globals.front().type);
}

/// A constant scalar takes no memory.
void make_constant(Checking& c, Variable& variable) {
    if (variable.type && variable.type->is_instance())
        c.fail(code::wrong_place, variable.name.place,
               "an instance changes when it is called, so it is no constant",
               "declare it in VAR, without CONSTANT");
    if (!variable.type || !variable.type->is_scalar()) return;
    variable.space = Space::constant;
    if (!variable.initial) {
        variable.value = variable.type->initial;
        if (!variable.name.place.dialect().constants_have_values) return;
        c.fail(code::not_a_constant, variable.name.place,
               fmt::format("the constant '{}' has no value", variable.text),
               "write ':= value' behind its type");
        return;
    }
    check_initial(c, variable);
    if (variable.initial->kind == E::constant) variable.value = variable.initial->constant;
}

Variable* declare_global(Checking& c, const Declaration& declared, bool constant, bool retain) {
    Type& all = global_variables(c);
    const Type* type = resolve(c, *declared.type);
    if (!is_new_name(c, declared.name, c.users.places)) return nullptr;
    Variable* variable = add(c, c.checked.variables, declared, type);
    if (type && type->kind == Kind::handle) return declare_object(c, *variable);
    variable->constant = constant;
    variable->retain = retain;
    locate_in_image(c, *variable, declared);
    variable->section = Section::global;
    if (variable->space == Space::frame) {
        variable->space = Space::global;
        variable->global = 0;
    }
    if (constant) make_constant(c, *variable);
    if (variable->space == Space::global) all.members.push_back(variable);
    c.globals.emplace(declared.name.text, variable);
    return variable;
}

void declare_result(Checking& c, Routine& routine) {
    const TypeText* text = routine.pou->result;
    if (!text || same_name(text->name.text, "void")) return;
    if (routine.has_instances()) {
        c.fail(code::wrong_place, text->place, "only functions and methods have a result",
               "declare a VAR_OUTPUT");
        return;
    }
    Variable& result = routine.variables.emplace_back();
    result.name = routine.pou->name;
    result.text = result.name.text;
    result.type = resolve(c, *text);
    result.section = Section::result;
    result.of = routine.pou;
    result.used = true;
    routine.result = &result;
    routine.names.emplace(result.text, &result);
}

/// `go : BOOL R_EDGE` has an instance beside it, which nobody can name.
void declare_edge(Checking& c, Routine& routine, Variable& variable, const Token& edge) {
    const bool fits = variable.type && variable.type->kind == Kind::boolean &&
                      variable.section == Section::input && routine.has_instances();
    if (!fits) {
        c.fail(code::wrong_place, edge.place,
               fmt::format("{} is for a BOOL of VAR_INPUT of a function block or a program",
                           edge.text),
               "declare an instance of R_TRIG or F_TRIG, and call it");
        return;
    }
    Variable& instance = routine.variables.emplace_back();
    instance.name = edge;
    instance.text = c.checked.names.emplace_back(fmt::format("{}.{}", variable.text, edge.text));
    instance.type = standard_type(c, same_name(edge.text, "r_edge") ? "r_trig" : "f_trig");
    instance.of = routine.pou;
    instance.used = true;
    routine.names.emplace(instance.text, &instance);
    variable.edge = &instance;
}

void declare(Checking& c, Routine& routine, const DeclarationBlock& block) {
    for (const Declaration* declared : block.declarations) {
        const Type* type = resolve(c, *declared->type);
        if (block.section == Section::in_out && type == &string_type) type = &open_string_type;
        Variable* variable = add(c, routine.variables, *declared, type);
        variable->section = block.section;
        variable->constant = block.constant;
        variable->retain = block.retain;
        variable->of = routine.pou;
        if (block.section == Section::in_out && !(type && type->is_handle()))
            variable->space = Space::reference;
        const auto [it, added] = routine.names.emplace(variable->text, variable);
        if (!added)
            c.fail(code::declared_twice, declared->name.place,
                   fmt::format("'{}' is declared twice", variable->text),
                   it->second->section == Section::result
                       ? "the function's own name is that of its result"
                       : fmt::format("first in line {}", it->second->name.place.mark().line));
        if (type && type->is_instance() && !routine.has_instances() && !routine.is_test() &&
            block.section != Section::in_out)
            c.fail(code::wrong_place, declared->name.place,
                   "a function keeps nothing from call to call, so it has no instances",
                   "pass the instance as VAR_IN_OUT");
        depend(c, type, declared->name.place);
        locate_in_image(c, *variable, *declared);
        if (routine.pou->is_tests || routine.is_test()) make_object(c, *variable);
        if (block.constant && block.section != Section::input) make_constant(c, *variable);
        if (declared->edge.word != Word::end_of_file)
            declare_edge(c, routine, *variable, declared->edge);
    }
}

}  // namespace

void collect_names(Checking& c) {
    collect_namespaces(c);
    for (const TypeDeclaration& declared : c.tree.types) {
        const Token name = name_with_namespace(c, declared.name);
        Names& names = c.names_beside(name);
        if (is_new_name(c, name, names.places))
            names.types.emplace(name.text, NamedType{&declared});
    }
    for (Pou* pou : c.tree.units) {
        c.has_tests |= pou->is_tests;
        const Token full_name = name_with_namespace(c, pou->name);
        Names& all = c.names_beside(full_name);
        const bool added = is_new_name(c, full_name, all.places);
        if (pou->kind == PouKind::data_block) continue;
        Routine& routine = c.make_routine(*pou, std::string(full_name.text));
        if (added) all.routines.emplace(full_name.text, &routine);
        if (routine.is_function()) continue;
        routine.type = &c.make_type(Kind::block, routine.name);
        routine.type->routine = &routine;
        NameMap<Place> names;
        for (Pou* method : pou->methods) {
            const std::string name(method->name.text);
            Routine& made =
                c.make_routine(*method, pou->is_tests ? name : routine.name + "." + name);
            made.owner = &routine;
            const bool is_test = pou->is_tests && method->name.word != Word::setup_ &&
                                 method->name.word != Word::teardown_;
            if (is_new_name(c, method->name, names, is_test) && !is_test)
                routine.methods.emplace(method->name.text, &made);
        }
    }
    for (const DeclarationBlock& block : c.tree.globals)
        for (const Declaration* declared : block.declarations)
            if (block.constant) c.constants.emplace(declared->name.text, declared);
    for (const TypeDeclaration& declared : c.tree.types)
        if (NamedType* type = c.look_up(&Names::types, declared.name)) resolve_declared(c, *type);
}

Variable* add(Checking& c, std::deque<Variable>& to, const Declaration& declared,
              const Type* type) {
    Variable& variable = to.emplace_back();
    variable.name = declared.name;
    variable.text = declared.name.text;
    variable.type = type;
    variable.initial = declared.initial;
    variable.doc = declared.doc;
    check_unit(c, variable, declared);
    return &variable;
}

Variable* declare_early(Checking& c, std::string_view name) {
    constexpr int most_hops = 200;
    const auto it = c.constants.find(name);
    if (it == c.constants.end() || c.hops == most_hops ||
        !c.begun_constants.insert(it->second).second)
        return nullptr;
    ++c.hops;
    Variable* variable = declare_global(c, *it->second, true, false);
    --c.hops;
    return variable;
}

void declare_globals(Checking& c) {
    for (const DeclarationBlock& block : c.tree.globals)
        for (const Declaration* declared : block.declarations)
            if (!block.constant || c.begun_constants.insert(declared).second)
                declare_global(c, *declared, block.constant, block.retain);
    c.constants.clear();
    for (Pou* pou : c.tree.units) {
        if (pou->kind != PouKind::data_block) continue;
        const int number = static_cast<int>(c.checked.globals.size());
        const Type* type = nullptr;
        if (pou->base) {
            type = resolve(c, *pou->base);
        } else {
            Type& made = c.make_type(Kind::structure, std::string(pou->name.text));
            for (const DeclarationBlock& block : pou->blocks)
                for (const Declaration* declared : block.declarations) {
                    made.members.push_back(
                        add(c, c.checked.variables, *declared, resolve(c, *declared->type)));
                    made.members.back()->retain = block.retain;
                }
            type = &made;
        }
        Variable& variable = c.checked.variables.emplace_back();
        variable.name = pou->name;
        variable.text = pou->name.text;
        variable.type = type;
        variable.section = Section::global;
        variable.space = Space::global;
        variable.global = number;
        c.checked.globals.push_back({std::string(pou->name.text), type, pou});
        c.globals.emplace(pou->name.text, &variable);
    }
}

void declare_routines(Checking& c) {
    for (Routine& routine : c.checked.routines) {
        c.routine = &routine;
        declare_result(c, routine);
        for (const bool constant : {true, false})  // bounds may name what stands further down
            for (const DeclarationBlock& block : routine.pou->blocks)
                if ((block.constant && block.section == Section::local) == constant)
                    declare(c, routine, block);
    }
    c.routine = nullptr;
    for (Routine& method : c.checked.routines)  // it works on what its block is made of
        if (method.owner) {
            const Routine& owner = *method.owner;
            method.calls.insert(method.calls.end(), owner.calls.begin(), owner.calls.end());
            method.call_places.insert(method.call_places.end(), owner.call_places.begin(),
                                      owner.call_places.end());
        }
}

}  // namespace lineshaft::st

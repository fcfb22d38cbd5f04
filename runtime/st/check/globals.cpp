#include <algorithm>
#include <utility>

#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"

namespace lineshaft::st {

namespace {

/// All that stands in VAR_GLOBAL.
Type& global_variables(Checking& c) {
    if (c.checked.globals.empty())
        c.checked.globals.push_back({"globals", &c.make_type(Kind::structure, "globals")});
    return const_cast<Type&>(*c.checked.globals.front().type);
}

/// `Trace : Trace;`, where CODESYS tells by the place which is meant, as SIMATIC AX does; before a
/// PROGRAM the variable is.
bool is_beside_a_type(Checking& c, const Token& name) {
    const Dialect& dialect = name.place.dialect();
    if (c.globals.contains(name.text)) return false;
    const Routine* block = find_in(c.users.routines, name.text);
    const bool is_type = block && block->pou->kind == PouKind::function_block;
    if (dialect.variables_hide_types) return c.users.types.contains(name.text) || is_type;
    if (!dialect.is_loose && !dialect.capitals_count) return false;
    const bool is_program = block && block->pou->kind == PouKind::program && dialect.is_loose;
    return is_type || is_program || (block && is_folder(*block->pou)) ||
           c.users.types.contains(name.text);
}

bool is_other_by_capitals(Checking& c, const Token& name) {
    const Variable* known = find_in(c.globals, name.text);
    return known && differs_in_capitals(*known, name) &&
           !c.by_capitals.contains({known->of, name.text});
}

/// TwinCAT's lists of globals may have the same names: the variable that was the first; null: none.
const Variable* in_another_list(Checking& c, const DeclarationBlock& block, const Token& name) {
    const Variable* known = find_in(c.globals, name.text);
    const bool is_of_list = known && !block.list.empty() && name.place.dialect().is_loose &&
                            known->section == Section::global;
    return is_of_list && known->name.place.source != name.place.source ? known : nullptr;
}

/// Axes of one name in several lists are several: each is called by its list and its name.
void declare_axis(Checking& c, const DeclarationBlock& block, Variable& axis) {
    const auto name_by_list = [&](Checking::ListedAxis& listed) {
        const std::string_view list = listed.list.substr(listed.list.rfind('.') + 1);
        std::string& name = c.checked.globals[static_cast<std::size_t>(listed.global)].name;
        if (!list.empty()) name = fmt::format("{}_{}", list, listed.name);
    };
    declare_object(c, axis);
    Checking::ListedAxis own{block.list, axis.name.text, axis.global};
    const auto [first, is_first] = c.listed_axes.emplace(axis.name.text, own);
    if (is_first || first->second.list == block.list) return;
    name_by_list(first->second);
    name_by_list(own);
}

Variable* declare_global(Checking& c, const DeclarationBlock& block, const Declaration& declared) {
    if (!is_library(declared.name)) global_variables(c);
    const Type* type = resolve(c, *declared.type);
    const std::string_view in_list = name_in_list(c, block, declared);
    Token name = name_of_global(c, declared);
    const bool is_axis = type && type->kind == Kind::handle;  // which its bare name means, too
    const Variable* const first =
        block.is_qualified_only && !is_axis ? nullptr : in_another_list(c, block, name);
    if (first) c.in_several_lists.emplace(name.text, std::pair(first->name, declared.name));
    if (first || block.is_qualified_only) name.text = in_list;
    const bool is_other = is_other_by_capitals(c, name);
    if (!is_other && !is_beside_a_type(c, name) && !is_new_name(c, name, c.users.places))
        return nullptr;
    Variable* variable = add(c, c.checked.variables, declared, type);
    c.globals.emplace(in_list, variable);
    if (is_axis) {
        declare_axis(c, block, *variable);
        return variable;
    }
    variable->text = name.text;
    variable->constant = block.constant;
    variable->retention = declared.retention;
    locate_in_image(c, *variable, declared);
    refuse_overlay(c, declared);
    variable->section = Section::global;
    if (variable->space == Space::frame) {
        variable->space = Space::global;
        variable->global = 0;
    }
    refuse_abstract(c, type, declared.name.place);
    if (block.constant) make_constant(c, *variable);
    if (variable->space == Space::global) global_variables(c).members.push_back(variable);
    if (is_other) c.by_capitals.emplace(std::pair(variable->of, name.text), variable);
    if (!block.is_qualified_only) c.globals.emplace(name.text, variable);
    return variable;
}

/// Both declarations say one type (6.5.2.2); a STRING may be declared without its length.
void compare_types(Checking& c, const Declaration& external, const Variable& global) {
    if (!global.type || global.type->kind == Kind::handle) return;
    const Type* type = resolve(c, *external.type);
    const bool are_texts = type && type->kind == Kind::text && global.type->kind == Kind::text;
    if (!type || are_texts || same_type(*type, *global.type)) return;
    c.fail(code::type_does_not_fit, external.type->place,
           fmt::format("'{}' is {} in VAR_GLOBAL, not {}", external.name.text,
                       describe(*global.type), describe(*type)),
           "write the type that VAR_GLOBAL has");
}

/// A VAR_EXTERNAL means the VAR_GLOBAL of its name; where none is here it declares one, as those of
/// a controller's modules, which other tools make.
void declare_externals(Checking& c) {
    for (const DeclarationBlock& block : c.tree.globals)
        for (const Declaration* declared : block.declarations) {
            const Token& name = declared->name;
            if (block.section != Section::external) continue;
            if (const Variable* global = find_in(c.globals, name.text)) {
                c.note(name.place, *global);
                compare_types(c, *declared, *global);
            }
            if (c.globals.contains(name.text) || c.users.places.contains(name.text)) continue;
            const Type* type = resolve(c, *declared->type);
            if (!type || type->kind == Kind::handle) continue;
            c.warn(code::not_declared, name.place,
                   fmt::format("no VAR_GLOBAL declares '{}'", name.text),
                   "it is a variable of its own here: declare it where its value comes from");
            declare_global(c, {.section = Section::global}, *declared);
        }
}

/// `DB5` is the data block that has the number, unless one has the name.
void name_by_numbers(Checking& c) {
    for (const Pou* pou : c.tree.units) {
        if (pou->kind != PouKind::data_block || pou->number.empty()) continue;
        Variable* const block = find_in(c.globals, pou->name.text);
        const std::string& name = c.checked.names.emplace_back(fmt::format("DB{}", pou->number));
        if (block) c.globals.emplace(name, block);
    }
}

}  // namespace

std::string_view name_in_list(Checking& c, const DeclarationBlock& block,
                              const Declaration& declared) {
    return c.checked.names.emplace_back(fmt::format("{}.{}", block.list, declared.name.text));
}

Token name_of_global(Checking& c, const Declaration& declared) {
    return is_library(declared.name) ? declared.name : name_with_namespace(c, declared.name);
}

bool differs_in_capitals(const Variable& known, const Token& name) {
    return name.place.dialect().capitals_count && known.text != name.text;
}

bool is_folder(const Pou& pou) {
    return pou.kind == PouKind::program && !pou.name.place.dialect().programs_are_named &&
           pou.name.place.dialect().capitals_count;
}

Variable* declare_early(Checking& c, const Checking::GlobalConstant& constant) {
    constexpr int most_hops = 200;
    const auto [block, declared] = constant;
    if (c.hops == most_hops || !c.begun_constants.insert(declared).second) return nullptr;
    ++c.hops;
    Variable* variable = declare_global(c, *block, *declared);
    --c.hops;
    return variable;
}

void declare_globals(Checking& c) {
    for (const DeclarationBlock& block : c.tree.globals)
        for (const Declaration* declared : block.declarations)
            if (block.section == Section::global &&
                (!block.constant || c.begun_constants.insert(declared).second))
                declare_global(c, block, *declared);
    declare_externals(c);
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
                    refuse_overlay(c, *declared);
                    made.members.push_back(
                        add(c, c.checked.variables, *declared, resolve(c, *declared->type)));
                    made.members.back()->retention = declared->retention;
                }
            type = &made;
        }
        Variable& variable = c.make_variable(pou->name, pou->name.text, type);
        variable.section = Section::global;
        variable.space = Space::global;
        variable.global = number;
        c.checked.globals.push_back({std::string(pou->name.text), type, pou});
        c.globals.emplace(pou->name.text, &variable);
        c.note(variable.name.place, variable);
    }
    name_by_numbers(c);
}

void note_update(Checking& c, const Variable& variable) {
    Routine* update = find_in(c.users.routines, fmt::format("{}.Update", variable.text));
    if (update && update != c.routine && std::ranges::find(c.updates, update) == c.updates.end())
        c.updates.push_back(update);
}

void bring_up_to_date(Checking& c, Routine& routine) {
    const Expression like{.token = routine.pou->name, .place = routine.pou->place};
    for (Routine* update : std::exchange(c.updates, {})) {
        Expression* call = make_call(c, like, make_name(c, like, update->name), {});
        check_routine_call(c, call, *update, true);
        routine.body.insert(routine.body.begin(), make_call_statement(c, call));
    }
}

}  // namespace lineshaft::st

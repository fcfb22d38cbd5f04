#include "runtime/st/check/declarations.hpp"

#include <utility>

#include "runtime/source/units.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/open_arrays.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/check/variants.hpp"

namespace lineshaft::st {

namespace {

void check_unit(Checking& c, Variable& variable, const Declaration& declared) {
    if (declared.unit.empty()) return;
    variable.unit = declared.unit;
    if (!Unit::parse(variable.unit))
        c.fail(code::unknown_unit, declared.unit_place,
               fmt::format("'{}' is not a unit", declared.unit), "lineshaft units lists them");
}

/// `n := 5` of CONST, which has no type but that of its value.
const Type* make_untyped_constant(Checking& c, Variable& variable) {
    const Type* type = check(c, variable.initial);
    if (type && !evaluate(c, variable.initial))
        type = c.fail(code::not_a_constant, variable.initial->place,
                      "the value of a CONST is a constant");
    if (!type) return nullptr;
    variable.space = Space::constant;
    variable.value = variable.initial->constant;
    return variable.type = type;
}

/// Functions and methods of one name whose arguments are of other types.
bool is_overload(const Pou& routine, const Routine* first,
                 const NameMap<std::vector<Routine*>>& overloads, std::string_view name) {
    const bool may_be = first && routine.accessor == Accessor::none && !routine.is_action &&
                        first->pou->kind == routine.kind && !first->pou->is_action;
    if (!may_be) return false;
    const std::string own = signature_of(routine);
    const std::vector<Routine*>* several = find_in(overloads, name);
    const auto all = several ? *several : std::vector{const_cast<Routine*>(first)};
    return std::ranges::none_of(all,
                                [&](const Routine* r) { return signature_of(*r->pou) == own; });
}

void add_overload(NameMap<std::vector<Routine*>>& to, std::string_view name, Routine& first,
                  Routine& next) {
    auto& all = to[name];
    if (all.empty()) all.push_back(&first);
    all.push_back(&next);
    next.name += fmt::format("({})", signature_of(*next.pou));
}

void declare_result(Checking& c, Routine& routine) {
    const TypeText* text = routine.pou->result;
    if (!text || same_name(text->name.text, "void")) return;
    if (routine.has_instances())
        return void(c.fail(code::wrong_place, text->place,
                           "only functions and methods have a result", "declare a VAR_OUTPUT"));
    const Token& name = routine.pou->name;
    const Type* type = resolve(c, *text);
    Variable& result = c.make_variable(routine, name, name.text, type);
    result.section = Section::result;
    routine.result = &result;
    routine.names.emplace(result.text, &result);
    if (is_its_own_block(c, routine, type))
        give_own_instance(c, routine, result);
    else if (!routine.is_prototype())
        depend(c, type, text->place);
}

/// `go : BOOL R_EDGE` has an instance beside it, which nobody can name.
void declare_edge(Checking& c, Routine& routine, Variable& variable, const Token& edge) {
    const bool fits = variable.type && variable.type->kind == Kind::boolean &&
                      variable.section == Section::input && routine.has_instances();
    if (!fits)
        return void(
            c.fail(code::wrong_place, edge.place,
                   fmt::format("{} is for a BOOL of VAR_INPUT of a function block or a program",
                               edge.text),
                   "declare an instance of R_TRIG or F_TRIG, and call it"));
    Variable& instance = c.make_variable(
        routine, edge, c.checked.names.emplace_back(fmt::format("{}.{}", variable.text, edge.text)),
        standard_type(c, same_name(edge.text, "r_edge") ? "r_trig" : "f_trig"));
    routine.names.emplace(instance.text, &instance);
    variable.edge = &instance;
}

/// `a : ARRAY[*] OF INT` is given as where its first element is, and its bounds beside it, the
/// lower and the upper one of each dimension.
void declare_bounds(Checking& c, Routine& routine, Variable& array) {
    if (array.is_parameter()) {
        array.section = Section::input;
        array.space = Space::frame;
    }
    for (std::size_t i = 0; i < 2 * array.type->dimensions; ++i) {
        Variable& made = c.make_variable(
            routine, array.name, c.checked.names.emplace_back(bound_name(array, i % 2 == 0, i / 2)),
            &lint_type);
        made.section = array.section;
        made.bound_of = &array;
        routine.names.emplace(made.text, &made);
    }
}

/// A VAR_IN_OUT CONSTANT takes a text of any length; SIZEOF is that of the type.
const Type& open_text(Checking& c, const Type& text) {
    Type& type = c.make_type(Kind::text, text.name);
    type.length = text.length;
    type.is_wide = text.is_wide;
    type.is_open = true;
    return type;
}

/// On an S7 what is elementary is given to a call by value.
bool copies_in_out(const Routine& routine, const Type& type) {
    const bool is_structured = type.kind == Kind::moment && !type.counts_ns;
    return routine.pou->name.place.dialect().copies_in_outs && type.is_scalar() &&
           !type.is_handle() && !type.is_reference() && type.kind != Kind::interface &&
           !is_structured;
}

/// A block keeps which axis it was given last. Of a call the variable itself is meant, which a
/// pointer to it outlives.
bool is_copied(const Routine& routine, const Type* type) {
    const Source& source = *routine.pou->name.place.source;
    const bool has_pointers = !source.dialect.has_no_pointers && !source.is_prelude();
    if (!type || !type->is_handle()) return type && copies_in_out(routine, *type);
    return routine.has_instances() || !has_pointers;
}

/// What a declaration means, of which a variable is made.
struct Meant {
    const Declaration& declared;
    const Type* type = nullptr;
    Section section = Section::local;
    bool constant = false;
    bool is_of_own = false;   ///< an instance of the block that declares it
    bool is_another = false;  ///< which cannot stand in that itself

    bool is_static() const { return section == Section::static_ || is_another; }
    Place place() const { return declared.name.place; }
};

const Type* declared_type(Checking& c, const TypeText* text, bool is_given) {
    if (!text) return nullptr;
    return is_given || refers_to_open_array(*text) ? resolve_parameter(c, *text)
                                                   : resolve(c, *text);
}

Meant meaning_of(Checking& c, const Routine& routine, const DeclarationBlock& block,
                 const Declaration& declared) {
    const bool is_given = block.section == Section::in_out || block.section == Section::input ||
                          (block.section == Section::output && !routine.has_instances());
    const Type* type = declared_type(c, declared.type, is_given);
    const bool is_pointed_at = is_given && type && is_variant(*type);
    const Section section = is_pointed_at ? Section::input : block.section;
    const Place place = declared.name.place;
    const bool is_wide = type == &unsized_wide_string(place) && type->is_wide;
    const bool is_unsized = is_wide || type == &unsized_string(place.dialect());
    const bool is_text = type && type->kind == Kind::text;
    const bool is_text_of_br = is_text && place.dialect().in_outs_take_any_text;
    if (section == Section::in_out && is_text && block.constant)
        type = &open_text(c, *type);
    else if (section == Section::in_out && (is_unsized || is_text_of_br))
        type = type->is_wide ? &open_wide_string_type : &open_string_type;
    const bool is_of_own = is_its_own_block(c, routine, type);
    return {.declared = declared,
            .type = type,
            .section = section,
            .constant = block.constant && !is_pointed_at,
            .is_of_own = is_of_own,
            .is_another = is_of_own && (section == Section::local || section == Section::temp)};
}

Variable& make_variable(Checking& c, Routine& routine, const DeclarationBlock& block,
                        const Meant& meant) {
    auto& all = meant.is_static() ? c.checked.variables : routine.variables;
    Variable& variable = *add(c, all, meant.declared, meant.type);
    variable.section = meant.is_static() ? Section::global : meant.section;
    variable.constant = meant.constant;
    variable.retention = meant.declared.retention;
    variable.of = routine.pou;
    variable.access = block.access;
    if (meant.section == Section::in_out && !is_copied(routine, meant.type))
        variable.space = Space::reference;
    return variable;
}

/// Under its name, which no other variable of the routine or of a base has.
void give_name(Checking& c, Routine& routine, Variable& variable, const Meant& meant) {
    const auto [it, added] = routine.names.emplace(variable.text, &variable);
    if (added && meant.is_of_own && meant.section == Section::input)
        it->second = &take_own_instance(c, routine, variable);
    if (added) return;
    const Variable& other = *it->second;
    const bool is_of_base = other.of != routine.pou;
    const bool is_result = other.section == Section::result;
    if (is_of_base && other.access == Access::private_)
        it->second = &variable;  // of a base that keeps its own to itself
    else if (is_result && meant.place().dialect().capitals_count)
        it->second = &variable;
    else if (differs_in_capitals(other, meant.declared.name))
        c.by_capitals.emplace(std::pair(variable.of, variable.text), &variable);
    else
        c.fail(code::declared_twice, meant.place(),
               fmt::format("'{}' is declared twice", variable.text),
               is_of_base
                   ? fmt::format("a base has it already, in line {}", other.name.place.mark().line)
               : is_result ? "the function's own name is that of its result"
                           : fmt::format("first in line {}", other.name.place.mark().line));
}

/// Instances and blocks of the program where there are none, and what has to be laid out before.
void check_instances(Checking& c, const Routine& routine, const Variable& variable,
                     const Meant& meant) {
    const Type* type = meant.type;
    const bool is_kept = routine.has_instances() || routine.is_test() || meant.is_static() ||
                         meant.section == Section::kept || meant.section == Section::in_out;
    if (type && type->is_instance() && !is_kept &&
        !meant.place().dialect().takes_what_others_refuse)
        c.fail(code::wrong_place, meant.place(),
               "a function keeps nothing from call to call, so it has no instances",
               "pass the instance as VAR_IN_OUT");
    const bool is_of_test = routine.pou->is_tests || routine.is_test();
    const bool is_array = type && type->kind == Kind::array;
    const bool is_lent = variable.space == Space::reference;
    if (is_lent || (variable.space == Space::frame && (!is_of_test || is_array)))
        refuse_object(c, meant.declared, type);
    if (!is_lent) refuse_abstract(c, type, meant.place());
    const bool is_only_named =
        (meant.is_of_own && (is_lent || meant.is_another || meant.section == Section::output)) ||
        (routine.is_prototype() && type && type->kind == Kind::block);
    if (!is_only_named) depend(c, type, meant.place());
}

/// Where it stands: at an address, or once for all calls.
void give_place(Checking& c, Routine& routine, Variable& variable, const Meant& meant) {
    locate_in_image(c, variable, meant.declared);
    const bool is_value = meant.constant && meant.type && meant.type->is_scalar();
    if (!meant.is_static() || variable.space != Space::frame || is_value) return;
    variable.text = c.checked.names.emplace_back(fmt::format("{}.{}", routine.name, variable.text));
    keep_once(c, variable);
    if (meant.is_another) begin_anew(c, routine, variable);
}

/// What else comes with it, and what it is as a constant.
void complete(Checking& c, Routine& routine, Variable& variable, const Meant& meant) {
    if (meant.type && meant.type->is_open_array()) declare_bounds(c, routine, variable);
    if (routine.pou->is_tests || routine.is_test()) make_object(c, variable);
    if (!meant.declared.type)
        make_untyped_constant(c, variable);
    else if (meant.constant && meant.section != Section::input)
        make_constant(c, variable);
    if (meant.declared.edge.word != Word::end_of_file)
        declare_edge(c, routine, variable, meant.declared.edge);
}

void declare(Checking& c, Routine& routine, const DeclarationBlock& block) {
    for (const Declaration* declared : in_order(block)) {
        const Meant meant = meaning_of(c, routine, block, *declared);
        Variable& variable = make_variable(c, routine, block, meant);
        give_name(c, routine, variable, meant);
        check_instances(c, routine, variable, meant);
        if (meant.is_of_own && meant.section == Section::output)
            give_own_instance(c, routine, variable);
        give_place(c, routine, variable, meant);
        complete(c, routine, variable, meant);
    }
}

/// `Block.constant` may be named from anywhere, in types too.
void list_constants(Checking& c, const Routine& block) {
    for (const DeclarationBlock& own : block.pou->blocks) {
        if (!own.constant || own.section != Section::local) continue;
        DeclarationBlock& list = c.constants_of_blocks.emplace_back(own);
        list.section = Section::global;
        list.list = block.name;
        list.is_qualified_only = true;
        for (const Declaration* declared : list.declarations)
            c.constants.emplace(name_in_list(c, list, *declared),
                                Checking::GlobalConstant{&list, declared});
    }
}

void add_method(Routine& block, Routine& method) {
    block.own_methods.push_back(&method);
    auto& known = method.pou->accessor == Accessor::get   ? block.getters
                  : method.pou->accessor == Accessor::set ? block.setters
                                                          : block.methods;
    const auto [it, is_first] = known.emplace(method.pou->name.text, &method);
    if (!is_first) add_overload(block.overloads, method.pou->name.text, *it->second, method);
}

void collect_methods(Checking& c, Routine& block) {
    NameMap<Place> names;
    const bool has_tests = block.pou->is_tests;
    for (Pou* method : block.pou->methods) {
        const std::string name(method->name.text);
        Routine& made = c.make_routine(*method, has_tests ? name : block.name + "." + name);
        made.owner = &block;
        const bool is_test =
            has_tests && method->name.word != Word::setup_ && method->name.word != Word::teardown_;
        const bool is_second =
            method->accessor == Accessor::set && block.getters.contains(method->name.text);
        const Routine* known = find_in(block.methods, method->name.text);
        const bool is_other = is_overload(*method, known, block.overloads, method->name.text);
        const bool is_new = is_second || is_other || is_new_name(c, method->name, names, is_test);
        if (is_new && !is_test) add_method(block, made);
    }
}

/// Its base first, whose variables are its own.
void declare_routine(Checking& c, Routine& routine) {
    if (std::exchange(routine.is_declared, true)) return;
    if (routine.base) declare_routine(c, *routine.base);
    inherit_variables(routine);
    c.routine = &routine;
    if (routine.base) depend(c, routine.base->type, routine.pou->name.place);
    declare_result(c, routine);
    for (const bool constant : {true, false})  // bounds may name what stands further down
        for (const DeclarationBlock& block : routine.pou->blocks)
            if ((block.constant && (block.section == Section::local ||
                                    block.section == Section::static_)) == constant)
                declare(c, routine, block);
    declare_overlays(c, routine);
    declare_charts(c, routine);
}

}  // namespace

void make_constant(Checking& c, Variable& variable) {
    if (variable.space == Space::image) return;
    if (variable.type && variable.type->is_instance() && !variable.name.place.dialect().is_loose)
        c.fail(code::wrong_place, variable.name.place,
               "an instance changes when it is called, so it is no constant",
               "declare it in VAR, without CONSTANT");
    if (!variable.type || !variable.type->is_scalar() || variable.section == Section::in_out)
        return;
    variable.space = Space::constant;
    if (!variable.initial) {
        variable.value = variable.type->initial;
        if (!variable.name.place.dialect().constants_have_values) return;
        c.warn(code::not_a_constant, variable.name.place,
               fmt::format("the constant '{}' is what its type begins with", variable.text),
               "write ':= value' behind its type");
        return;
    }
    check_initial(c, variable);
    if (variable.initial->kind == E::constant)
        variable.value = variable.initial->constant;
    else
        variable.type = nullptr;  // what it is was told to be unknown
}

void refuse_object(Checking& c, const Declaration& declared, const Type* type) {
    const bool is_array = type && type->kind == Kind::array;
    while (type && type->kind == Kind::array) type = type->element;
    if (!type || !type->is_object()) return;
    c.fail(code::wrong_place, declared.name.place,
           fmt::format("{} is a block of the program, and no part of another", type->name),
           is_array ? "declare a variable for each"
                    : fmt::format("name it: {} : {};", declared.name.text, type->standard->handle));
}

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
        Routine* first = find_in(all.routines, full_name.text);
        const bool is_other = pou->kind == PouKind::function &&
                              is_overload(*pou, first, all.overloads, full_name.text);
        const bool is_beside = first && (is_folder(*pou) || is_folder(*first->pou));
        if (is_beside && !is_folder(*pou)) all.routines.erase(full_name.text);
        const bool is_beside_type = is_folder(*pou) && all.types.contains(full_name.text);
        const bool added =
            is_beside_type ||
            (is_beside ? !is_folder(*pou)
                       : !is_other && !is_told_by_capitals(c, full_name, all.places) &&
                             is_new_name(c, full_name, all.places));
        if (pou->kind == PouKind::data_block) continue;
        Routine& routine = c.make_routine(*pou, std::string(full_name.text));
        if (added) all.routines.emplace(full_name.text, &routine);
        if (is_other) add_overload(all.overloads, full_name.text, *first, routine);
        if (routine.is_function()) continue;
        routine.type = &c.make_type(Kind::block, routine.name);
        routine.type->routine = &routine;
        routine.type->pack = pou->name.place.dialect().most_aligned;
        if (routine.is_interface()) {
            routine.type->kind = Kind::interface;
            routine.type->slots = 1;
        }
        collect_methods(c, routine);
        if (added) list_constants(c, routine);
    }
    for (const DeclarationBlock& block : c.tree.globals)
        for (const Declaration* declared : block.declarations)
            if (block.constant && block.section == Section::global) {
                const Checking::GlobalConstant constant{&block, declared};
                c.constants.emplace(name_in_list(c, block, *declared), constant);
                if (!block.is_qualified_only)
                    c.constants.emplace(name_of_global(c, *declared).text, constant);
            }
    for (const TypeDeclaration& declared : c.tree.types)
        if (NamedType* type = c.look_up(&Names::types, declared.name)) resolve_declared(c, *type);
    resolve_targets(c);
}

Variable* add(Checking& c, std::deque<Variable>& to, const Declaration& declared,
              const Type* type) {
    Variable& variable = to.emplace_back();
    variable.name = declared.name;
    variable.text = declared.name.text;
    variable.type = type;
    variable.initial = declared.initial;
    variable.doc = declared.doc;
    variable.constructed = constructor_arguments(declared.type, type);
    check_unit(c, variable, declared);
    c.note(variable.name.place, variable);
    return &variable;
}

const std::vector<Argument>* constructor_arguments(const TypeText* text, const Type* type) {
    for (; text && text->kind == TypeText::Kind::array; text = text->element)
        if (type && type->kind == Kind::array) type = &type->innermost();
    const bool is_written = text && text->kind == TypeText::Kind::enumeration && type &&
                            text->name.word != Word::end_of_file;
    return is_written && type->kind == Kind::block ? &text->values : nullptr;
}

void keep_once(Checking& c, Variable& variable) {
    if (!c.statics) {
        c.statics = &c.make_type(Kind::structure, "statics");
        c.checked.globals.push_back(
            {.name = c.statics->name, .type = c.statics, .is_statics = true});
    }
    const auto global = std::ranges::find(c.checked.globals, c.statics, &Global::type);
    variable.section = Section::global;
    variable.space = Space::global;
    variable.of = nullptr;
    variable.global = static_cast<int>(global - c.checked.globals.begin());
    c.statics->members.push_back(&variable);
}

void declare_routines(Checking& c) {
    for (Routine& routine : c.checked.routines) declare_routine(c, routine);
    c.routine = nullptr;
    for (Routine& method : c.checked.routines)  // it works on what its block is made of
        if (method.owner) {
            const Routine& owner = *method.owner;
            method.calls.insert(method.calls.end(), owner.calls.begin(), owner.calls.end());
        }
}

}  // namespace lineshaft::st

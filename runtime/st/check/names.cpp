#include "runtime/st/check/names.hpp"

#include <iterator>

#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/s5.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/syntax/list_properties.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/s5.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

/// Else what stands in `"..."` is a text.
bool may_be_name(std::string_view text) {
    const auto in_name = [](char x) { return is_letter(x) || is_digit(x) || !is_ascii(x); };
    return !text.empty() && std::ranges::all_of(text, in_name);
}

const Type* unknown_name(Checking& c, const Expression& e) {
    const std::string_view name = e.token.text;
    if (const Routine* routine = c.find_routine(e.token)) {
        if (routine->type)
            return c.fail(code::wrong_place, e.place,
                          fmt::format("'{}' is a block, and has no value", name),
                          "declare an instance in VAR, and name that");
        return routine == c.routine
                   ? c.fail(code::wrong_place, e.place,
                            fmt::format("the function '{}' has no value", name),
                            fmt::format("declare of which type: FUNCTION {} : INT", name))
                   : c.fail(code::wrong_place, e.place, fmt::format("'{}' is a function", name),
                            fmt::format("call it: {}()", name));
    }
    return undeclared(c, e.token, e.place);
}

/// What has the variable of VAR_STAT whose initial value is being checked; null: none is.
const Routine* routine_of_static(const Checking& c) {
    const Variable* begun = c.beginning.variable;
    if (c.routine || !c.statics || !begun || begun->space != Space::global) return nullptr;
    if (c.checked.globals[static_cast<std::size_t>(begun->global)].type != c.statics)
        return nullptr;
    for (const Routine& routine : c.checked.routines)
        if (find_in(routine.names, begun->name.text) == begun) return &routine;
    return nullptr;
}

Variable* find_own(const Checking& c, const Token& token) {
    for (const Routine* r = c.routine; r && !token.quoted; r = r->owner)
        if (Variable* variable = find_in(r->names, token.text)) return variable;
    for (const Routine* r = routine_of_static(c); r && !token.quoted; r = r->owner) {
        Variable* variable = find_in(r->names, token.text);
        if (variable && variable != c.beginning.variable && variable->space == Space::global)
            return variable;
    }
    return nullptr;
}

/// `list.name` of a name within a list of globals whose variables are named with it from elsewhere.
std::optional<Token> name_in_own_list(Checking& c, const Token& token) {
    const DeclarationBlock* own = nullptr;
    for (const DeclarationBlock& block : c.tree.globals) {
        if (block.declarations.empty()) continue;
        const Place& first = block.declarations.front()->name.place;
        if (first.source == token.place.source && first.begin <= token.place.begin) own = &block;
    }
    if (!own) return {};
    const auto is_it = [&](const Declaration* d) { return same_name(d->name.text, token.text); };
    const auto has_it = [&](const DeclarationBlock& block) {
        return block.is_qualified_only && block.list == own->list &&
               std::ranges::any_of(block.declarations, is_it);
    };
    if (std::ranges::none_of(c.tree.globals, has_it)) return {};
    Token full = token;
    full.text = c.checked.names.emplace_back(fmt::format("{}.{}", own->list, token.text));
    return full;
}

/// Nothing runs, or what begins globals, or the PROPERTY of a list of them.
bool is_within_list(const Checking& c) {
    const Routine* r = c.routine;
    return !r || r == c.begin_of_globals ||
           (r->owner && r->owner->name.starts_with(list_properties));
}

Variable* find_global(Checking& c, const Token& token) {
    if (Variable* global = c.find_inside_out(c.globals, token)) return global;
    auto* constant = c.find_inside_out(c.constants, token);
    return constant ? declare_early(c, *constant) : nullptr;
}

/// `g` of `.g`, which is the global variable though a variable of the unit has that name.
Token named_behind_point(Token token) {
    token.text = without_point(token.text);
    return token;
}

/// `T1` of SCL is the timer, beside a tag `"T1"`.
bool is_hidden_by_s5(const Token& token, const Variable& global) {
    return is_instruction_name(token) && global.name.quoted && read_s5_number(token.text);
}

Variable* find_in_any_capitals(Checking& c, const Token& token) {
    if (token.text.starts_with('.')) return find_global(c, named_behind_point(token));
    if (Variable* own = find_own(c, token)) return own;
    if (token.local) return nullptr;
    if (const auto full = is_within_list(c) ? name_in_own_list(c, token) : std::nullopt)
        if (Variable* own = find_in_any_capitals(c, *full)) return own;
    if (!is_prelude(token))
        if (Variable* global = find_global(c, token); global && !is_hidden_by_s5(token, *global))
            return global;
    return token.quoted && c.routine ? find_in(c.routine->names, token.text) : nullptr;
}

/// What a name that nobody declares may be meant for. It is looked for many times in a block.
const std::vector<std::string>& visible_names(Checking& c) {
    Checking::KnownNames& known = c.known_names;
    const std::size_t count = c.globals.size() + c.users.values.size() + c.users.routines.size();
    const bool are_new = known.count != count;
    if (are_new) {
        known.count = count;
        known.everywhere.clear();
        for (const auto& [name, variable] : c.globals) known.everywhere.emplace_back(name);
        for (const auto& [name, value] : c.users.values) known.everywhere.emplace_back(name);
        for (const auto& [name, routine] : c.users.routines)
            if (!routine->type) known.everywhere.emplace_back(name);
        std::ranges::sort(known.everywhere);
    }
    if (!are_new && known.routine == c.routine) return known.here;
    known.routine = c.routine;
    std::vector<std::string> own;
    for (const Routine* r = c.routine; r; r = r->owner)
        for (const Variable* variable : all_variables(*r)) own.emplace_back(variable->text);
    std::ranges::sort(own);
    known.here.clear();
    std::ranges::merge(own, known.everywhere, std::back_inserter(known.here));
    return known.here;
}

/// A value of an enumeration is written exactly so.
bool is_exactly_a_value(Checking& c, const Token& token) {
    const NamedValue* value = token.local ? nullptr : c.look_up(&Names::values, token);
    return value && value->type->values[value->index] == token.text;
}

}  // namespace

Variable* find_variable(Checking& c, const Token& token) {
    Variable* found = find_in_any_capitals(c, token);
    const bool differs = found && found->text != token.text && token.place.source &&
                         token.place.dialect().capitals_count;
    if (!differs) return found;
    const auto exact = c.by_capitals.find({found->of, token.text});
    if (exact != c.by_capitals.end()) return exact->second;
    return is_exactly_a_value(c, token) ? nullptr : found;
}

const Routine* block_with_method(const Checking& c, const Token& token) {
    const Variable* own = find_own(c, token);
    if (own && own->type && own->type->is_instance()) return nullptr;
    for (const Routine* r = c.routine; r; r = r->owner)
        if (r->methods.contains(token.text)) return r;
    return nullptr;
}

bool is_own_variable(const Checking& c, const Token& token) {
    return find_own(c, token) != nullptr;
}

bool is_new_name(Checking& c, Token name, NameMap<Place>& names, bool is_test) {
    const auto [it, added] = names.emplace(name.text, name.place);
    if (added) return true;
    const Mark first = it->second.mark();
    const bool beside = first.file == name.place.source->file;
    const std::string help =
        fmt::format("first in {}{}", beside ? "line " : first.file->path + ":", first.line);
    if (!is_test)
        return c.fail(code::declared_twice, name.place,
                      fmt::format("'{}' is declared twice", name.text), help);
    c.warn(code::declared_twice, name.place, "two TESTs have one name", help);
    return false;
}

bool is_told_by_capitals(Checking& c, const Token& name, const NameMap<Place>& names) {
    const auto known = names.find(name.text);
    const bool is_other = known != names.end() && known->second.text() != name.text;
    if (!is_other || !name.place.dialect().capitals_count) return false;
    c.warn(code::declared_twice, name.place,
           fmt::format("'{}' differs from '{}' in capitals alone, and means that here", name.text,
                       known->second.text()),
           fmt::format("the first stands in line {}", known->second.mark().line));
    return true;
}

const Type* undeclared(Checking& c, const Token& name, Place place,
                       std::span<const std::string_view> functions) {
    if (may_be_elsewhere(c, place)) return nullptr;
    for (const Routine* r = c.routine; r; r = r->owner)
        if (r->has_unknown_base) return nullptr;
    if (c.tree.lost.contains(name.text) || !c.undeclared[c.routine].insert(name.text).second)
        return nullptr;
    const auto meant = [&] {
        if (functions.empty()) return nearest(name.text, visible_names(c));
        std::vector<std::string> names = visible_names(c);
        names.insert(names.end(), functions.begin(), functions.end());
        return nearest(name.text, names);
    };
    std::vector<std::string> near = meant();
    std::erase(near, name.text);
    const bool is_text =
        name.quoted &&
        (!may_be_name(name.text) || (near.empty() && place.dialect().quotes_may_enclose_texts));
    if (near.empty() && !is_text && c.may_be_foreign(name)) return nullptr;
    const std::string_view of_vendor =
        is_text ? std::string_view() : instead_of_undeclared(name.text, near.empty());
    return c.fail(code::not_declared, place, fmt::format("'{}' is not declared", name.text),
                  !of_vendor.empty() ? std::string(of_vendor)
                  : is_text          ? "a text stands in '...', a name in \"...\""
                                     : suggest(name.text, near));
}

const Type* use(Checking& c, Expression*& e, Variable& variable) {
    variable.used = true;
    if (variable.space == Space::global && is_library(variable.name)) note_update(c, variable);
    e->variable = &variable;
    c.note(e->token.place, variable);
    if (!variable.type) return nullptr;
    if (variable.space == Space::constant) {
        e = make_constant(c, *e, *variable.type, variable.value);
        e->variable = &variable;
        return variable.type;
    }
    if (variable.space == Space::overlay) return use_overlay(c, e, variable);
    if (c.routine && variable.type->is_object()) c.routine->objects.push_back(variable.global);
    return variable.type;
}

namespace {

/// The type of that name, an enumeration even if it stands behind the type that asks for it.
const Type* known_type(Checking& c, NamedType& named) {
    const bool is_behind = !c.knows_types && !named.type && !named.visiting &&
                           named.declaration->type->kind == TypeText::Kind::enumeration;
    return is_behind ? resolve_declared(c, named) : named.type;
}

/// The value, of an enumeration behind the type that asks for it, too: all that have it are known
/// then.
const NamedValue* find_value(Checking& c, const Token& token) {
    const NamedValue* found = c.look_up(&Names::values, token);
    if (found || c.knows_types) return found;
    const auto is_it = [&](const Argument& a) { return same_name(a.name.text, token.text); };
    for (const TypeDeclaration& declared : c.tree.types)
        if (std::ranges::any_of(declared.type->values, is_it))
            if (NamedType* named = c.look_up(&Names::types, declared.name)) known_type(c, *named);
    return c.look_up(&Names::values, token);
}

}  // namespace

const Type* enumeration_of(Checking& c, const Expression& member) {
    const Expression& of = *member.operands[0];
    const auto name = of.kind == E::name ? of.token : qualified_name(c, of);
    if (!name || name->local) return nullptr;
    const Variable* variable = find_variable(c, *name);
    if (variable && !(variable->type && variable->type->is_scalar())) return nullptr;
    NamedType* named = c.look_up(&Names::types, *name);
    const Type* type = named ? known_type(c, *named) : nullptr;
    if (!type || !type->has_values()) return nullptr;
    c.note(of.place, *named);
    return type;
}

const Type* become_value(Checking& c, Expression*& e, const Type& type, std::size_t index) {
    if (type.is_real()) return become(c, e, type, {.real = type.reals[index]});
    return become(c, e, type, {.integer = type.numbers[index]});
}

const Type* check_value(Checking& c, Expression*& e, const Type& enumeration, const Token& name) {
    const std::string* found = find_called(enumeration.values, name.text);
    if (!found)
        return c.fail(code::not_declared, name.place,
                      fmt::format("{} has no value '{}'", enumeration.name, name.text),
                      suggest(name.text, enumeration.values));
    const auto index = static_cast<std::size_t>(found - enumeration.values.data());
    c.note_value(name.place, enumeration, index);
    return become_value(c, e, enumeration, index);
}

namespace {

/// A global variable that is named without its list, of which there are several.
bool is_ambiguous(Checking& c, const Token& token, const Variable& variable) {
    const auto lists = c.in_several_lists.find(without_point(token.text));
    if (lists == c.in_several_lists.end() || variable.section != Section::global) return false;
    const auto& [first, second] = lists->second;
    const Mark one = first.place.mark(), other = second.place.mark();
    c.fail(code::declared_twice, token.place,
           fmt::format("'{}' stands in several lists", token.text),
           fmt::format("write the list's name and '.' before it: {}:{} and {}:{}", one.file->path,
                       one.line, other.file->path, other.line));
    return true;
}

/// A variable of a base is one unless that keeps it to itself.
bool is_own_to_name(Checking& c, const Token& token, const Variable& variable) {
    if (variable.access != Access::private_ || !variable.of) return true;
    const Routine* block = c.routine && c.routine->owner ? c.routine->owner : c.routine;
    while (block && block->pou != variable.of) block = block->base;
    return !block || is_accessible(c, variable.access, *block, token);
}

/// A value of an enumeration with the attribute 'qualified_only', where the value is due.
const Type* refuse_alone(Checking& c, const Expression& e, const Type& enumeration) {
    return c.fail(code::not_declared, e.place, fmt::format("'{}' is not declared", e.token.text),
                  fmt::format("write {}.{}, which the attribute 'qualified_only' asks for",
                              enumeration.name, e.token.text));
}

/// Whether a variable is meant where a value of an enumeration of that name is due. In TwinCAT that
/// is not the BOOL of METHOD Execute in `state := EXECUTE`, which is no value.
bool is_variable_for(Checking& c, const Token& token) {
    const Variable* variable = find_variable(c, token);
    if (!variable) return false;
    const bool is_truth = variable->section == Section::result && variable->type &&
                          variable->type->kind == Kind::boolean;
    return !is_truth || !token.place.source || !token.place.dialect().is_loose;
}

/// The enumeration with the value that a variable of this block's, or of what it extends, has for
/// itself: `state : (idle, busy);`.
const Type* own_enumeration_with(Checking& c, const Token& token) {
    if (token.local || token.quoted || !token.place.source || !token.place.dialect().is_loose)
        return nullptr;
    for (const Routine* r = c.routine; r; r = r->owner)
        for (const Variable* variable : all_variables(*r)) {
            const Type* type = variable->type;
            while (type && type->kind == Kind::array) type = type->element;
            const bool is_own = type && type->is_unnamed && type->has_values();
            if (is_own && find_called(type->values, token.text)) return type;
        }
    return nullptr;
}

}  // namespace

namespace {

/// Whether `"..."` is a text, though a variable is called so: where a text is due it is the name of
/// a global STRING alone, where a character is due that of one.
bool is_text_for(Checking& c, const Expression& e, const Type* expected) {
    const Dialect& dialect = e.place.dialect();
    if (!e.token.quoted || dialect.is_loose) return e.token.quoted;
    const bool is_due = expected && (expected->kind == Kind::text || expected->is_character);
    if (!is_due || !dialect.quotes_may_enclose_texts) return false;
    const Variable* variable = find_variable(c, e.token);
    const bool is_character =
        variable && variable->type && variable->type->is_character && expected->is_character;
    return variable && !is_character &&
           (expected->is_wide || !variable->type || variable->section != Section::global ||
            variable->type->kind != Kind::text);
}

/// TRUE and FALSE are words of the language; `"TRUE"` may be a tag.
bool is_truth(const Token& token) {
    return same_name(token.text, "true") || same_name(token.text, "false");
}

/// A value that is named without its enumeration. Empty: none is called so.
std::optional<const Type*> check_value_alone(Checking& c, Expression*& e) {
    const Token& token = e->token;
    const NamedValue* value = token.local ? nullptr : find_value(c, token);
    if (!value) return {};
    if (value->ambiguous)
        return c.fail(code::not_declared, e->place,
                      fmt::format("'{}' is a value of several enumerations", token.text),
                      fmt::format("write {}#{}", value->type->name, token.text));
    c.note_value(token.place, *value->type, value->index);
    return become_value(c, e, *value->type, value->index);
}

}  // namespace

const Type* check_name(Checking& c, Expression*& e, const Type* expected) {
    const Token& token = e->token;
    if (token.word == Word::direct)
        return is_any_pointer(token.text) ? check_any_pointer(c, e) : check_direct(c, *e);
    if (!token.quoted && !token.local && is_truth(token))
        return become(c, e, bool_type, {.integer = same_name(token.text, "true")});
    const bool is_text = is_text_for(c, *e, expected);
    if (expected && expected->has_values() && !token.local && !is_text) {
        const std::string* value = find_called(expected->values, token.text);
        if (value && !is_variable_for(c, token))
            return expected->is_qualified_only && e->place.dialect().is_loose
                       ? refuse_alone(c, *e, *expected)
                       : check_value(c, e, *expected, token);
    }
    Routine* getter = find_accessor(c, *e, Accessor::get);
    Variable* variable = is_text || getter ? nullptr : find_variable(c, token);
    if (!variable && !getter) variable = declare_program(c, token);
    const bool takes_text = expected && (expected->kind == Kind::text || expected->is_character);
    const bool is_due = takes_text || !may_be_name(token.text);
    const bool may_be_text =
        !variable && is_due && token.quoted && e->place.dialect().quotes_may_enclose_texts;
    if (is_text || may_be_text) {
        e = make_text(c, *e);
        return check(c, e, expected);
    }
    if (variable && is_ambiguous(c, token, *variable)) return nullptr;
    if (variable && !is_own_to_name(c, token, *variable)) return nullptr;
    const bool is_for_object = expected && expected->kind == Kind::handle;
    if (variable && is_for_object && hides_object(token, *variable))
        return use_object(c, e, *object_type(c, *expected));
    if (variable) {
        const Type* type = variable->edge ? use_edge(c, e, *variable) : use(c, e, *variable);
        return is_s5_number(type) ? signal_of_s5(c, e, *type, expected) : type;
    }
    if (is_own_instance(c, *e)) return check_own_instance(c, e);
    if (getter) return check_getter(c, e, *getter);
    if (expected && expected->kind == Kind::interface && same_name(token.text, "null"))
        return become(c, e, *expected, {});
    if (is_truth(token)) return become(c, e, bool_type, {.integer = same_name(token.text, "true")});
    if (const auto type = check_value_alone(c, e)) return *type;
    if (same_name(token.text, "eno") && c.routine && c.routine->pou->kind != PouKind::data_block)
        return use(c, e, eno_of(c, *c.routine));
    if (is_for_object && !token.local && (token.quoted || !c.is_in_test()))
        return use_object(c, e, *object_type(c, *expected));
    if (same_name(token.text, "null") && !token.quoted && !token.local)
        return become(c, e, null_type, {});
    if (token.place.source && token.place.dialect().packs_as_s7 &&
        read_classic_address(token.text)) {
        e = make_copy(c, *e);
        e->token.word = Word::direct;
        return check_direct(c, *e);
    }
    if (const Type* own = own_enumeration_with(c, token)) return check_value(c, e, *own, token);
    if (const auto type = check_s5_name(c, e, expected)) return *type;
    return unknown_name(c, *e);
}

}  // namespace lineshaft::st

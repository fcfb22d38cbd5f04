#include "runtime/st/check/beginnings.hpp"

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/places.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view constructor = "fb_init";

bool is_of_call(const Routine& routine, const Variable& variable) {
    return variable.section == Section::temp ||
           (variable.section != Section::kept && !routine.has_instances());
}

bool may_begin(const Checking& c) {
    const Variable* variable = c.beginning.variable;
    if (!variable || !c.routine) return false;
    const bool is_own = variable->section == Section::local || variable->section == Section::temp ||
                        variable->section == Section::kept || variable->section == Section::output;
    return is_own && !variable->constant && variable->space == Space::frame;
}

/// `variable.a[3].b`, which is to begin with something.
Expression* place_of(Checking& c, const Expression& like) {
    Expression* place = make_name(c, like, c.beginning.variable->text);
    for (const auto& [member, index] : c.beginning.path)
        place = member.empty() ? make_element(c, place, index) : make_member(c, place, member);
    return place;
}

/// What the memory has there until then.
Expression* nothing(Checking& c, const Expression& like, const Type& type) {
    if (type.is_scalar() || type.is_reference() || type.kind == Kind::interface)
        return make_constant(c, like, type, {});
    if (type.kind == Kind::text) return make_constant(c, like, type, {.text = ""});
    Expression* list = make(c, E::list, like);
    list->token.word = Word::open;
    list->type = &type;
    return list;
}

/// Assigned once, of the block alone and not of its bases, or of a method what it keeps.
void add_once(Checking& c, Routine& block, Place place, Block& to) {
    if (block.begins.empty()) return;
    if (!block.begun) {
        Variable& begun = block.variables.emplace_back();
        begun.name = block.pou->name;
        begun.text = c.checked.names.emplace_back(fmt::format("{}.begun", block.pou->name.text));
        begun.type = &bool_type;
        begun.section = block.has_instances() ? Section::local : Section::kept;
        begun.of = block.pou;
        begun.used = true;
        block.begun = &begun;
    }
    const auto flag = [&] {
        Expression like;
        like.token = block.pou->name;
        like.place = place;
        Expression* name = make(c, E::name, like);
        name->variable = block.begun;
        name->type = &bool_type;
        return name;
    };
    Block first = {make_assignment(c, place, flag(), make_boolean(c, *flag(), true))};
    first.insert(first.end(), block.begins.begin(), block.begins.end());
    Expression* condition = make(c, E::unary, *flag());
    condition->op = Word::not_;
    condition->operands[0] = flag();
    to.push_back(make_if(c, place, condition, std::move(first), {}));
}

void add_bases_first(Checking& c, Routine& block, Place place, Block& to) {
    if (block.base) add_bases_first(c, *block.base, place, to);
    add_once(c, block, place, to);
}

/// A call of the method with `values` for what it has beyond its first two inputs.
Statement* call_constructor(Checking& c, const Expression& like, Expression* instance,
                            std::vector<Argument> values, const Routine& method) {
    std::vector<Argument> given;
    for (const Variable& input : method.variables) {
        if (input.section != Section::input || given.size() == 2) continue;
        const bool by_place = !values.empty() && (!values[0].is_named() || !values[0].value);
        given.push_back(
            {.name = by_place ? Token{} : input.name, .value = make_boolean(c, like, false)});
    }
    for (const Argument& value : values)
        given.push_back(value.value ? value
                                    : Argument{.value = make_name(c, like, value.name.text)});
    return make_call_statement(
        c, make_call(c, like, make_member(c, instance, method.pou->name.text), std::move(given)));
}

/// That of the base, with the inputs of its own that the method has, too.
void add_constructor_of_base(Checking& c, const Routine& method, Block& to) {
    const Routine* base = method.owner->base;
    const auto it = base ? base->methods.find(constructor) : NameMap<Routine*>::const_iterator{};
    if (!base || it == base->methods.end()) return;
    Expression like;
    like.token = method.pou->name;
    like.place = method.pou->place;
    std::vector<Argument> given;
    for (const Variable& input : it->second->variables)
        if (input.section == Section::input)
            given.push_back({.name = input.name, .value = make_name(c, like, input.text)});
    Expression* super = make_name(c, like, "super");
    to.push_back(make_call_statement(
        c,
        make_call(c, like, make_member(c, super, it->second->pou->name.text), std::move(given))));
}

}  // namespace

bool is_constructed(const Type* type) {
    return type && type->kind == Kind::block && type->routine->methods.contains(constructor);
}

bool begin_with(Checking& c, Expression*& value, const Type& type) {
    if (!may_begin(c)) return false;
    Statement* s = make_assignment(c, value->place, place_of(c, *value), value);
    if (type.is_alias()) s->op = Word::reference_assign;
    const bool of_call = is_of_call(*c.routine, *c.beginning.variable);
    (of_call ? c.routine->call_begins : c.routine->begins).push_back(s);
    c.beginning.is_made = true;
    if (!is_constant(*value)) value = nothing(c, *value, type);
    return true;
}

void begin_instance(Checking& c, Variable& variable) {
    const bool has_values = variable.constructed && !variable.constructed->empty();
    const Type* type = variable.type;
    const bool is_block = type && type->kind == Kind::block && variable.space == Space::frame;
    Routine* method = nullptr;
    if (is_block)
        if (const auto it = type->routine->methods.find(constructor);
            it != type->routine->methods.end())
            method = it->second;
    if (!method) {
        if (has_values && type)
            c.fail(code::wrong_arguments, variable.name.place,
                   fmt::format("{} takes no arguments behind its name", describe(*type)),
                   "a FUNCTION_BLOCK with a METHOD FB_init does: name : Block(argument := value)");
        return;
    }
    const bool is_kept = variable.section == Section::kept;
    if (!c.routine || !(c.routine->has_instances() || is_kept)) return;
    Expression like;
    like.token = variable.name;
    like.place = variable.name.place;
    c.routine->begins.push_back(
        call_constructor(c, like, make_name(c, like, variable.text),
                         has_values ? *variable.constructed : std::vector<Argument>{}, *method));
}

Block beginnings(Checking& c, Routine& routine) {
    Block made;
    if (routine.is_prototype() || routine.is_test() || routine.pou->is_tests) return made;
    Routine* block = routine.owner ? routine.owner : &routine;
    if (block->has_instances()) add_bases_first(c, *block, routine.pou->place, made);
    if (routine.owner) add_once(c, routine, routine.pou->place, made);
    if (routine.owner && same_name(routine.pou->name.text, constructor))
        add_constructor_of_base(c, routine, made);
    made.insert(made.end(), routine.call_begins.begin(), routine.call_begins.end());
    return made;
}

}  // namespace lineshaft::st

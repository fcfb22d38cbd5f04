#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view constructor = "fb_init";

bool is_of_call(const Routine& routine, const Variable& variable) {
    return variable.section == Section::temp || !routine.has_instances();
}

bool may_begin(const Checking& c) {
    const Variable* variable = c.beginning.variable;
    if (!variable || !c.routine || c.beginning.is_repeated) return false;
    const bool is_own = variable->section == Section::local || variable->section == Section::temp ||
                        variable->section == Section::output;
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

/// Assigned once, of the block alone and not of its bases.
void add_once(Checking& c, Routine& block, Place place, Block& to) {
    if (block.begins.empty()) return;
    if (!block.begun) {
        const Token& name = block.pou->name;
        block.begun = &c.make_variable(
            block, name, c.checked.names.emplace_back(fmt::format("{}.begun", name.text)),
            &bool_type);
    }
    const Expression like{.token = block.pou->name, .place = place};
    const auto flag = [&] { return make_use(c, like, *block.begun); };
    Block first = {make_assignment(c, place, flag(), make_boolean(c, like, true))};
    first.insert(first.end(), block.begins.begin(), block.begins.end());
    to.push_back(make_if(c, place, make_not(c, flag()), std::move(first), {}));
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
    const Routine* of_base = base ? find_in(base->methods, constructor) : nullptr;
    if (!of_base) return;
    const Expression like{.token = method.pou->name, .place = method.pou->place};
    std::vector<Argument> given;
    for (const Variable& input : of_base->variables)
        if (input.section == Section::input)
            given.push_back({.name = input.name, .value = make_name(c, like, input.text)});
    Expression* super = make_name(c, like, "super");
    to.push_back(make_call_statement(
        c, make_call(c, like, make_member(c, super, of_base->pou->name.text), std::move(given))));
}

}  // namespace

bool begin_with(Checking& c, Expression*& value, const Type& type) {
    if (!may_begin(c)) return false;
    Statement* s = make_assignment(c, value->place, place_of(c, *value), value);
    if (type.is_alias()) s->op = Word::reference_assign;
    const bool of_call = is_of_call(*c.routine, *c.beginning.variable);
    (of_call ? c.routine->call_begins : c.routine->begins).push_back(s);
    c.beginning.is_made = true;
    value = nothing(c, *value, type);
    return true;
}

void begin_instance(Checking& c, Variable& variable) {
    const bool has_values = variable.constructed && !variable.constructed->empty();
    const Type* type = variable.type;
    const bool is_block = type && type->kind == Kind::block && variable.space == Space::frame;
    const Routine* method = is_block ? find_in(type->routine->methods, constructor) : nullptr;
    if (!method) {
        if (has_values && type)
            c.fail(code::wrong_arguments, variable.name.place,
                   fmt::format("{} takes no arguments behind its name", describe(*type)),
                   "a FUNCTION_BLOCK with a METHOD FB_init does: name : Block(argument := value)");
        return;
    }
    if (!c.routine || !c.routine->has_instances()) return;
    const Expression like{.token = variable.name, .place = variable.name.place};
    c.routine->begins.push_back(
        call_constructor(c, like, make_name(c, like, variable.text),
                         has_values ? *variable.constructed : std::vector<Argument>{}, *method));
}

Block beginnings(Checking& c, Routine& routine) {
    Block made;
    if (routine.is_prototype() || routine.is_test() || routine.pou->is_tests) return made;
    Routine* block = routine.owner ? routine.owner : &routine;
    if (block->has_instances()) add_bases_first(c, *block, routine.pou->place, made);
    if (routine.owner && same_name(routine.pou->name.text, constructor))
        add_constructor_of_base(c, routine, made);
    made.insert(made.end(), routine.call_begins.begin(), routine.call_begins.end());
    return made;
}

}  // namespace lineshaft::st

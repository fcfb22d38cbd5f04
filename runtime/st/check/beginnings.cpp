#include <algorithm>
#include <functional>
#include <utility>

#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view constructor = "fb_init";

bool is_of_call(const Routine& routine, const Variable& variable) {
    return variable.section == Section::temp ||
           (variable.section != Section::kept && !routine.has_instances());
}

bool may_begin(const Checking& c) {
    const Variable* variable = c.beginning.variable;
    if (!variable) return false;
    if (!c.routine) return variable->space == Space::global && !variable->constant;
    const bool is_own =
        variable->section == Section::local || variable->section == Section::temp ||
        variable->section == Section::kept || variable->section == Section::output ||
        (variable->section == Section::input && c.routine->pou->kind == PouKind::function_block);
    return is_own && !variable->constant && variable->space == Space::frame;
}

/// One that no source names has its type already.
Expression* named(Checking& c, const Expression& like, Variable& variable) {
    Expression* name = make_name(c, like, variable.text);
    if (variable.space == Space::frame) return name;
    variable.used = true;
    name->variable = &variable;
    name->type = variable.type;
    return name;
}

/// `variable.a[3].b`, which is to begin with something.
Expression* place_of(Checking& c, const Expression& like) {
    Expression* place = named(c, like, *c.beginning.variable);
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

/// A variable that no source has, named after what stands at `like` as none of a source is.
Variable& add_hidden(Checking& c, std::deque<Variable>& to, const Expression& like,
                     std::string_view name, const Type& type) {
    Variable& made = to.emplace_back();
    made.name = like.token;
    made.text = c.checked.names.emplace_back(fmt::format("{} {}", like.token.text, name));
    made.type = &type;
    made.used = true;
    return made;
}

Expression like_name(const Token& name, Place place) {
    Expression like;
    like.token = name;
    like.place = place;
    return like;
}

/// `IF NOT flag THEN flag := TRUE; begins END_IF`
Statement* make_once(Checking& c, const Expression& like, Variable& flag, const Block& begins) {
    Block first = {
        make_assignment(c, like.place, make_use(c, like, flag), make_boolean(c, like, true))};
    first.insert(first.end(), begins.begin(), begins.end());
    return make_if(c, like.place, make_not(c, make_use(c, like, flag)), std::move(first), {});
}

/// Assigned once, of the block alone and not of its bases, or of a method what it keeps.
void add_once(Checking& c, Routine& block, Place place, Block& to) {
    if (block.begins.empty()) return;
    const Expression like = like_name(block.pou->name, place);
    if (!block.begun) {
        block.begun = &add_hidden(c, block.variables, like, "begun", bool_type);
        block.begun->of = block.pou;
        block.begun->section = block.has_instances() ? Section::local : Section::kept;
        block.begun->retention = Retention::non_retain;
    }
    to.push_back(make_once(c, like, *block.begun, make_copies(c, block.begins)));
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
        const bool is_retains = given.empty();  // bInitRetains, behind which comes bInCopyCode
        given.push_back(
            {.name = by_place ? Token{} : input.name, .value = make_boolean(c, like, is_retains)});
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
    const Expression like = like_name(method.pou->name, method.pou->place);
    std::vector<Argument> given;
    for (const Variable& input : of_base->variables)
        if (input.section == Section::input || input.section == Section::in_out)
            given.push_back({.name = input.name, .value = make_name(c, like, input.text)});
    Expression* super = make_name(c, like, "super");
    to.push_back(make_call_statement(
        c, make_call(c, like, make_member(c, super, of_base->pou->name.text), std::move(given))));
}

/// FB_init of a block; null: it has none.
Routine* constructor_of(const Type& block) {
    return find_in(block.routine->methods, constructor);
}

/// Methods of a block with `{attribute 'call_after_init'}`, those of its base first. One that
/// another replaces is that.
std::vector<std::string_view> methods_behind(const Routine& block) {
    std::vector<std::string_view> names;
    if (block.base) names = methods_behind(*block.base);
    for (const Routine* method : block.own_methods) {
        const std::string_view name = method->pou->name.text;
        const auto is_it = [&](std::string_view other) { return same_name(other, name); };
        if (method->pou->follows_init && std::ranges::none_of(names, is_it)) names.push_back(name);
    }
    return names;
}

/// What members of structures begin with is assigned first, then FB_init is called, then what each
/// declares of its variable is assigned, then comes what follows.
enum class Phase : std::uint8_t { members, init, behind_init };

/// Where what is constructed stands, and who counts through its elements.
struct Constructing {
    Expression like;
    std::deque<Variable>& counters;
    const Pou* of;
    Phase phase = Phase::init;
};

/// There is something to call of it then.
bool is_called(const Checking& c, Phase phase, const Type* type) {
    if (!type) return false;
    if (type->kind == Kind::array) return is_called(c, phase, type->element);
    if (type->kind == Kind::structure)
        return std::ranges::any_of(type->members, [&](const Variable* member) {
            const bool begins = phase == Phase::members && c.begins_of_members.contains(member);
            return begins || is_called(c, phase, member->type);
        });
    if (type->kind != Kind::block || phase == Phase::members) return false;
    return phase == Phase::init ? constructor_of(*type) || beginning_of(*type)
                                : !methods_behind(*type->routine).empty();
}

/// `Block[(a := 1), (a := 2)]`: the arguments of each element; null: all have the same.
const Expression* each_of(const std::vector<Argument>* values) {
    if (!values || values->size() != 1 || values->front().is_named()) return nullptr;
    const Expression* list = values->front().value;
    return list && list->kind == E::list && !list->is_structure() ? list : nullptr;
}

/// A reference begins with what it refers to.
Statement* assign_first(Checking& c, Expression* to, const Expression& value, const Type& type) {
    Statement* made = make_assignment(c, value.place, to, make_copy(c, value));
    if (type.is_alias()) made->op = Word::reference_assign;
    return made;
}

void construct(Checking& c, const Constructing& at, const Type& type,
               const std::vector<Argument>* values, const std::function<Expression*()>& part,
               Block& to);

void construct_each(Checking& c, const Constructing& at, const Type& array, const Expression& list,
                    const std::function<Expression*()>& part, Block& to) {
    const auto given = static_cast<std::int64_t>(list.arguments.size());
    if (given != static_cast<std::int64_t>(array.count())) {
        c.fail(code::wrong_arguments, list.place,
               fmt::format("the array has {} elements, and arguments for {} are given",
                           array.count(), given));
        return;
    }
    for (std::int64_t i = 0; i < given; ++i) {
        const auto element = [&] {
            Expression* made = make(c, E::index, at.like);
            made->operands[0] = part();
            made->arguments.push_back(
                {.value = make_constant(c, at.like, lint_type, {.integer = array.lower + i})});
            return made;
        };
        const Expression& one = *list.arguments[static_cast<std::size_t>(i)].value;
        construct(c, at, *array.element, &one.arguments, element, to);
    }
}

/// Calls FB_init of the instances in `part`, which makes a node each time, with `values`.
void construct(Checking& c, const Constructing& at, const Type& type,
               const std::vector<Argument>* values, const std::function<Expression*()>& part,
               Block& to) {
    if (!is_called(c, at.phase, &type)) return;
    if (type.kind == Kind::block && at.phase == Phase::behind_init) {
        for (const std::string_view name : methods_behind(*type.routine))
            to.push_back(
                make_call_statement(c, make_call(c, at.like, make_member(c, part(), name), {})));
        return;
    }
    if (type.kind == Kind::block) {
        const auto given = values ? *values : std::vector<Argument>{};
        if (const Routine* begins = beginning_of(type))
            to.push_back(make_call_statement(
                c, make_call(c, at.like, make_member(c, part(), begins->pou->name.text), {})));
        if (const Routine* own = constructor_of(type))
            to.push_back(call_constructor(c, at.like, part(), given, *own));
        return;
    }
    if (type.kind == Kind::structure) {
        for (const Variable* member : type.members) {
            const auto own = [&] { return make_member(c, part(), member->text); };
            const auto begins = c.begins_of_members.find(member);
            if (at.phase == Phase::members && begins != c.begins_of_members.end()) {
                const Expression* value = with_members(c, begins->second, type.members, part);
                to.push_back(assign_first(c, own(), *value, *member->type));
            }
            construct(c, at, *member->type, member->constructed, own, to);
        }
        return;
    }
    if (const Expression* list = at.phase == Phase::init ? each_of(values) : nullptr)
        return construct_each(c, at, type, *list, part, to);
    Variable& counter =
        add_hidden(c, at.counters, at.like, fmt::format("index{}", at.counters.size()), lint_type);
    counter.of = at.of;
    const auto bound = [&](std::int64_t value) {
        return make_constant(c, at.like, lint_type, {.integer = value});
    };
    Statement* loop =
        make_assignment(c, at.like.place, make_use(c, at.like, counter), bound(type.lower));
    loop->kind = S::for_;
    loop->limit = bound(type.upper);
    const auto element = [&] {
        Expression* made = make(c, E::index, at.like);
        made->operands[0] = part();
        made->arguments.push_back({.value = make_use(c, at.like, counter)});
        return made;
    };
    construct(c, at, *type.element, values, element, loop->body);
    to.push_back(loop);
}

/// What VAR_GLOBAL begins with.
Routine& begin_of_globals(Checking& c, const Expression& like) {
    if (c.begin_of_globals) return *c.begin_of_globals;
    Pou& pou = c.tree.pous.emplace_back();
    pou.kind = PouKind::function;
    pou.name = like.token;
    pou.place = like.place;
    Routine& made = c.checked.routines.emplace_back();
    made.pou = &pou;
    made.name = "VAR_GLOBAL";
    c.prelude.routines.emplace(made.name, &made);
    c.begin_of_globals = &made;
    return made;
}

/// An instance of the block, or an array or a structure of them.
bool holds(const Type& type, const Routine& block) {
    if (type.kind == Kind::array) return holds(*type.element, block);
    if (type.kind == Kind::structure)
        return std::ranges::any_of(type.members, [&](const Variable* member) {
            return member->type && holds(*member->type, block);
        });
    return type.kind == Kind::block && type.routine == &block;
}

/// No other block has an instance of it, nor has VAR_GLOBAL, so that nothing runs before it.
bool is_first(const Checking& c, const Routine& block) {
    if (block.is_test() || block.pou->kind == PouKind::program) return true;
    if (std::ranges::any_of(c.checked.globals,
                            [&](const Global& global) { return holds(*global.type, block); }))
        return false;
    const auto has_it = [&](const Routine& other) {
        return other.owner != &block &&
               std::ranges::find(other.calls, &block, &Called::routine) != other.calls.end();
    };
    return !block.owner && block.has_instances() && !block.pou->is_tests &&
           std::ranges::none_of(c.checked.routines, has_it);
}

}  // namespace

bool is_constructed(const Checking& c, const Type* type) {
    return is_called(c, Phase::init, type);
}

bool begins_by_itself(const Checking& c, const Type* type) {
    return is_constructed(c, type) || is_called(c, Phase::members, type);
}

bool is_followed(const Checking& c, const Type* type) {
    return is_called(c, Phase::behind_init, type);
}

bool has_constructor(const Checking& c, const Type* type) {
    while (type && type->kind == Kind::array) type = type->element;
    const bool is_block = type && type->kind == Kind::block;
    return is_block ? constructor_of(*type) != nullptr : is_constructed(c, type);
}

void refuse_constructor_arguments(Checking& c, Place place, const Type& type) {
    if (type.has_unknown_base || (type.routine && type.routine->has_unknown_base)) return;
    c.fail(code::wrong_arguments, place,
           fmt::format("{} takes no arguments behind its name", describe(type)),
           "a FUNCTION_BLOCK with a METHOD FB_init does: name : Block(argument := value)");
}

void construct_one(Checking& c, const Expression& like, Routine& routine, const Type& type,
                   const std::vector<Argument>* values, const std::function<Expression*()>& part,
                   Block& to) {
    for (const Phase phase : {Phase::init, Phase::behind_init})
        construct(c, {like, routine.variables, routine.pou, phase}, type, values, part, to);
}

/// What a variable begins with that is retained, or whose instance may be: once in all runs then.
static Statement* make_once_in_all_runs(Checking& c, Routine& of, Statement* begins) {
    const Variable& variable = *c.beginning.variable;
    const bool is_global = variable.space == Space::global;
    const Expression like = like_name(variable.name, begins->place);
    auto& all = is_global ? c.checked.variables : of.variables;
    std::string name = "begun";
    for (const auto& [member, index] : c.beginning.path)
        name += fmt::format(" {}", member.empty() ? std::to_string(index) : std::string(member));
    Variable& flag = add_hidden(c, all, like, name, bool_type);
    flag.retention = variable.retention;
    flag.of = is_global ? nullptr : of.pou;
    flag.section = of.has_instances() || is_global ? Section::local : Section::kept;
    if (is_global) keep_once(c, flag);
    return make_once(c, like, flag, {begins});
}

bool begin_with(Checking& c, Expression*& value, const Type& type) {
    if (c.beginning.member && c.beginning.path.empty() && !is_constant(*value)) {
        c.begins_of_members[c.beginning.member] = value;
        value = nothing(c, *value, type);
        return c.beginning.is_made = true;
    }
    if (!may_begin(c)) return false;
    Statement* s = make_assignment(c, value->place, place_of(c, *value), value);
    if (type.is_alias()) s->op = Word::reference_assign;
    c.beginnings.insert(s);
    Routine& of = c.routine ? *c.routine : begin_of_globals(c, *value);
    const Variable& variable = *c.beginning.variable;
    const bool is_of_one = is_of_call(of, variable);
    const bool is_as_instance =
        variable.retention == Retention::unsaid && of.pou->kind == PouKind::function_block;
    const bool is_kept = !type.is_reference() &&
                         (is_as_instance || variable.retention == Retention::retain) &&
                         (!is_of_one || variable.space == Space::global);
    (is_of_one ? of.call_begins : of.begins)
        .push_back(is_kept ? make_once_in_all_runs(c, of, s) : s);
    c.beginning.is_made = true;
    if (!is_constant(*value)) value = nothing(c, *value, type);
    return true;
}

namespace {

/// What is given to a call is constructed already.
bool is_to_begin(const Checking& c, const Variable& variable) {
    if (variable.space == Space::global) return !c.routine;
    if (variable.space != Space::frame || !c.routine) return false;
    return !is_of_call(*c.routine, variable) || variable.section == Section::local ||
           variable.section == Section::temp;
}

void begin_in(Checking& c, Variable& variable, Phase phase) {
    if (!is_called(c, phase, variable.type) || !is_to_begin(c, variable)) return;
    const Expression like = like_name(variable.name, variable.name.place);
    Routine& of = c.routine ? *c.routine : begin_of_globals(c, like);
    construct(
        c, {like, of.variables, of.pou, phase}, *variable.type, variable.constructed,
        [&] { return named(c, like, variable); },
        c.routine && !is_of_call(*c.routine, variable) ? of.begins : of.call_begins);
}

}  // namespace

void begin_instance(Checking& c, Variable& variable) {
    const Type* type = variable.type;
    if (variable.constructed && !variable.constructed->empty() && !has_constructor(c, type)) {
        if (type) refuse_constructor_arguments(c, variable.name.place, *type);
        return;
    }
    begin_in(c, variable, Phase::init);
}

void begin_members(Checking& c, Variable& variable) {
    const bool is_given = variable.section == Section::input || variable.section == Section::in_out;
    if (!is_called(c, Phase::members, variable.type) || variable.constant || is_given) return;
    const bool is_own = c.routine && variable.space == Space::frame;
    if (!is_own && (c.routine || variable.space != Space::global)) return;
    const Expression like = like_name(variable.name, variable.name.place);
    Routine& of = is_own ? *c.routine : begin_of_globals(c, like);
    const bool in_each_call = !is_own || is_of_call(of, variable);
    construct(
        c, {like, of.variables, of.pou, Phase::members}, *variable.type, nullptr,
        [&] { return named(c, like, variable); }, in_each_call ? of.call_begins : of.begins);
}

void follow_init(Checking& c, Variable& variable) {
    begin_in(c, variable, Phase::behind_init);
}

void begin_globals(Checking& c) {
    if (!c.begin_of_globals) return;
    Routine& begin = *c.begin_of_globals;
    const Expression like = like_name(begin.pou->name, begin.pou->place);
    Variable& begun = add_hidden(c, c.checked.variables, like, "begun", bool_type);
    keep_once(c, begun);
    for (Routine& routine : c.checked.routines) {
        if (!is_first(c, routine)) continue;
        Block& begins = routine.is_test() ? routine.call_begins : routine.begins;
        begins.insert(begins.begin(),
                      make_once(c, like, begun,
                                {make_call_statement(
                                    c, make_call(c, like, make_name(c, like, begin.name), {}))}));
    }
}

namespace {

/// What variables of a block begin with was checked in the block, of globals in no routine at all:
/// a routine that it is written into calls its functions, too.
void note_functions(Routine& of, const Expression* e) {
    if (!e) return;
    if (e->kind == E::call && e->routine && e->routine->is_function())
        of.calls.push_back({e->routine, e->place, false, true});
    for (const Expression* operand : e->operands) note_functions(of, operand);
    for (const Argument& argument : e->arguments) note_functions(of, argument.value);
}

void note_functions(Routine& of, const Block& block) {
    for (const Statement* s : block) {
        for (const Expression* e : {s->target, s->value, s->limit, s->step}) note_functions(of, e);
        for (const Branch& branch : s->branches) {
            note_functions(of, branch.condition);
            note_functions(of, branch.body);
        }
        note_functions(of, s->body);
    }
}

}  // namespace

Block beginnings(Checking& c, Routine& routine) {
    Block made;
    if (routine.is_prototype() || routine.pou->is_tests) return made;
    if (routine.is_test()) return routine.call_begins;
    Routine* block = routine.owner ? routine.owner : &routine;
    if (block->has_instances()) add_bases_first(c, *block, routine.pou->place, made);
    if (routine.owner) add_once(c, routine, routine.pou->place, made);
    if (routine.owner && same_name(routine.pou->name.text, constructor))
        add_constructor_of_base(c, routine, made);
    made.insert(made.end(), routine.call_begins.begin(), routine.call_begins.end());
    note_functions(routine, made);
    return made;
}

}  // namespace lineshaft::st

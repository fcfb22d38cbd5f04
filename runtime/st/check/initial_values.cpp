#include <utility>

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/dynamic_memory.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/types/parameters.hpp"

namespace lineshaft::st {

namespace {

bool is_constant_place(Checking& c, const Expression& place) {
    for (const Argument& index : place.arguments)
        if (index.value->kind != E::constant) return false;
    return !place.operands[0] || is_constant_place(c, *place.operands[0]);
}

/// A path begins at the data block itself, whatever else has the name of its member.
void begin_at_member(Expression& path, const Routine& parts) {
    Expression* first = &path;
    while (first->operands[0]) first = first->operands[0];
    if (find_in(parts.names, first->token.text)) first->token.quoted = false;
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
        begin_at_member(*s->target, parts);
        const Type* type = check(c, s->target);
        if (!is_constant_place(c, *s->target))
            c.fail(code::not_a_constant, s->target->place, "the index is not a constant");
        if (type) check_initial(c, s->value, *type);
    }
    c.routine = nullptr;
}

void check_part(Checking& c, Expression*& value, const Type& type, std::string_view member) {
    c.beginning.path.emplace_back(member, 0);
    check_initial(c, value, type);
    c.beginning.path.pop_back();
}

/// The elements of an array one behind the other: of all its dimensions, or of the first.
struct Elements {
    const Type& array;
    bool of_all;

    const Type& type() const { return of_all ? array.innermost() : *array.element; }
    Wide count() const {
        Wide made = Wide{array.upper} - array.lower + 1;
        for (const Type* t = &array; of_all && t->has_inner; t = t->element)
            made *= Wide{t->element->upper} - t->element->lower + 1;
        return made;
    }
};

void check_element(Checking& c, Expression*& value, const Elements& elements, Wide number) {
    auto& path = c.beginning.path;
    const std::size_t outer = path.size();
    Wide below = elements.count();
    const bool is_there = number < below;  // told otherwise, when all are counted
    for (const Type* t = &elements.array; is_there; t = t->element) {
        below /= Wide{t->upper} - t->lower + 1;
        path.emplace_back(std::string_view(), static_cast<std::int64_t>(t->lower + number / below));
        number %= below;
        if (!elements.of_all || !t->has_inner) break;
    }
    check_initial(c, value, elements.type());
    path.resize(outer);
}

/// `3(x)`, from the element of this number on. What is no constant is assigned to each.
void check_repeated(Checking& c, Expression& repeated, Wide times, const Elements& elements,
                    Wide number) {
    constexpr std::int64_t most_assigned = 10'000;
    const std::vector<Argument> written = repeated.arguments;
    const auto assigned = [&] {
        return c.routine ? c.routine->begins.size() + c.routine->call_begins.size() : 0;
    };
    const std::size_t before = assigned();
    for (Wide i = 0; i < std::max<Wide>(times, 1); ++i) {
        if (i == 1 && assigned() == before) return;
        for (std::size_t j = 0; j < written.size(); ++j) {
            repeated.arguments[j] = written[j];
            check_element(c, repeated.arguments[j].value, elements, number++);
        }
        if (assigned() - before > most_assigned)
            return (void)c.fail(code::too_deep_or_large, repeated.place,
                                "more than 10000 elements are assigned here",
                                "assign them in a loop, in the body");
    }
}

/// CODESYS and B&R: `[COUNT(5), (COUNT - 1)(6)]`, so many times as a constant says.
bool is_repeated_by_constant(Checking& c, const Expression& e) {
    if (e.kind != E::call || !e.place.dialect().takes_what_others_refuse) return false;
    const Expression* count = e.operands[0];
    if (count->kind == E::binary || count->kind == E::constant) return true;
    if (const auto name = count->kind == E::member ? qualified_name(c, *count) : std::nullopt)
        count = make_name(c, *count, name->text);
    const Variable* variable = count->kind == E::name ? find_variable(c, count->token) : nullptr;
    return variable && variable->space == Space::constant;
}

Expression* repeated_by_constant(Checking& c, const Expression& call) {
    Expression* made = make_copy(c, call);
    made->kind = E::repeated;
    return made;
}

Expression* as_elements(Checking& c, Expression* value) {
    Expression* list = make(c, E::list, *value);
    list->token.word = Word::open_bracket;
    list->arguments.push_back({.value = value});
    return list;
}

/// What stands in a list one by one; empty where that is not known, or too much.
std::vector<Argument> one_by_one(Checking& c, const Expression& list) {
    std::vector<Argument> values;
    for (const Argument& argument : list.arguments) {
        if (argument.value->kind != E::repeated) {
            values.push_back(argument);
            continue;
        }
        Expression* count = argument.value->operands[0];
        const auto times = check_whole(c, count, lint_type);
        const auto parts =
            static_cast<Wide>(std::max<std::size_t>(argument.value->arguments.size(), 1));
        if (!times || *times < 0 || *times * parts > most_elements) return {};
        for (Wide i = 0; i < *times; ++i)
            for (const Argument& part : argument.value->arguments)
                values.push_back({.value = make_copy(c, *part.value)});
    }
    return values;
}

/// `20(5(1))` of IEC 61131-3, 6.5.3: what is repeated within it stands there so many times.
void repeat_within(Checking& c, Expression& repeated) {
    const auto is_one = [](const Argument& a) { return a.value->kind == E::repeated; };
    while (std::ranges::any_of(repeated.arguments, is_one)) {
        std::vector<Argument> all = one_by_one(c, repeated);
        if (all.empty()) return;
        repeated.arguments = std::move(all);
    }
}

/// CoDeSys 2.3 has the values of an array of arrays one behind the other: here as lists.
void group_elements(Checking& c, Expression& list, const Type& array) {
    const Type& inner = array.innermost();
    const Wide room = Elements{array, true}.count();
    if (inner.kind != Kind::array || list.is_nested() || !list.place.dialect().is_loose) return;
    std::vector<Argument> values = one_by_one(c, list);
    if (static_cast<Wide>(values.size()) <= room) return;
    Wide parts = 1;
    for (const Type* t = &inner; t->kind == Kind::array; t = &t->innermost())
        parts *= Elements{*t, true}.count();
    list.arguments.clear();
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (static_cast<Wide>(i) % parts == 0)
            list.arguments.push_back({.value = as_elements(c, values[i].value)});
        else
            list.arguments.back().value->arguments.push_back(values[i]);
    }
}

/// Leaves out what is behind the first `room` of a checked list.
void leave_excess_out(Expression& list, Wide room) {
    std::vector<Argument> kept;
    for (Argument& argument : list.arguments) {
        if (room == 0) break;
        Expression& value = *argument.value;
        const bool is_repeated = value.kind == E::repeated;
        const auto parts =
            static_cast<Wide>(is_repeated ? std::max<std::size_t>(value.arguments.size(), 1) : 1);
        const Wide times = is_repeated ? value.operands[0]->constant.integer : 1;
        const Wide whole = std::min(times, room / parts);
        if (is_repeated) value.operands[0]->constant.integer = whole;
        if (whole > 0) kept.push_back(argument);
        room -= whole * parts;
        if (whole == times) continue;
        for (Wide i = 0; i < room; ++i)
            kept.push_back(value.arguments[static_cast<std::size_t>(i)]);
        room = 0;
    }
    list.arguments = std::move(kept);
}

/// IEC 61131-3, 6.4.4.5.2: the rightmost are ignored. Others refuse it.
void check_excess(Checking& c, Expression& list, Wide count, Wide room) {
    if (count <= room) return;
    const std::string told =
        fmt::format("{} values for {} elements", static_cast<std::int64_t>(count),
                    static_cast<std::int64_t>(room));
    constexpr const char* help = "leave some out, or make the array larger";
    if (!list.place.dialect().ignores_excess_values)
        return (void)c.fail(code::value_out_of_range, list.place, told, help);
    c.warn(code::value_out_of_range, list.place, told + ": the last are ignored", help);
    leave_excess_out(list, room);
}

/// Several dimensions have either a list of lists, or all elements in one, the last index first.
void check_elements(Checking& c, Expression& list, const Type& array) {
    group_elements(c, list, array);
    const Elements elements{array, !list.is_nested()};
    const Wide room = elements.count();
    Wide count = 0;
    for (Argument& argument : list.arguments) {
        if (is_repeated_by_constant(c, *argument.value))
            argument.value = repeated_by_constant(c, *argument.value);
        if (argument.value->kind != E::repeated) {
            check_element(c, argument.value, elements, count++);
            continue;
        }
        Expression* value = argument.value = make_copy(c, *argument.value);
        if (elements.type().kind != Kind::array) repeat_within(c, *value);
        const auto times = check_whole(c, value->operands[0], lint_type);
        const bool is_number = times && *times >= 0 && *times <= most_elements;
        check_repeated(c, *value, is_number ? *times : 1, elements, count);
        const Wide one = static_cast<Wide>(std::max<std::size_t>(value->arguments.size(), 1));
        if (is_number) count += *times * one;
    }
    check_excess(c, list, count, room);
}

/// CODESYS: a property that is set when the instance begins. False: there is none.
bool begins_property(Checking& c, Argument& argument, const Type& type) {
    if (type.kind != Kind::block || !argument.is_named()) return false;
    const Routine* setter = find_in(type.routine->setters, argument.name.text);
    const auto is_input = [](const Variable& v) { return v.section == Section::input && v.type; };
    const auto given = setter ? std::ranges::find_if(setter->variables, is_input)
                              : decltype(setter->variables.begin()){};
    if (!setter || given == setter->variables.end()) return false;
    c.beginning.path.emplace_back(argument.name.text, 0);
    const bool begins = begin_with(c, argument.value, *given->type);
    c.beginning.path.pop_back();
    return begins;
}

/// TIA Portal: `((), (), 0.1)`, where a member keeps the start value of its type.
bool is_left_open(Expression& value, const Type& type) {
    const bool has_several =
        type.kind == Kind::structure || type.kind == Kind::array || type.is_instance();
    const bool is_open = value.kind == E::list && value.arguments.empty() && !has_several &&
                         value.is_structure() && value.place.dialect().packs_as_s7;
    if (is_open) value.type = &type;
    return is_open;
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
    std::erase_if(list.arguments, [&](Argument& argument) {
        return !by_place && !find_member(type, argument.name.text) &&
               begins_property(c, argument, type);
    });
    for (std::size_t i = 0; i < list.arguments.size(); ++i) {
        Argument& argument = list.arguments[i];
        if (!by_place && !argument.is_named()) {
            c.fail(code::type_does_not_fit, argument.value->place, "this value has no name",
                   fmt::format("name the member of {}: (name := value)", describe(type)));
            continue;
        }
        Variable* found = by_place ? type.members[i] : find_member(type, argument.name.text);
        argument.variable = found;
        if (!found && lacks_base(type)) continue;
        if (!found)
            c.fail(code::not_declared, argument.name.place,
                   fmt::format("{} has no '{}'", describe(type), argument.name.text),
                   suggest(argument.name.text, names_of(type.members)));
        else if (found->type && !(by_place && is_left_open(*argument.value, *found->type)))
            check_part(c, argument.value, *found->type, found->text);
    }
}

/// `(0)`, which B&R and CODESYS 2.3 write for the initial values of what has several.
bool is_nothing(const Expression& value, const Type& type) {
    const bool has_several =
        type.kind == Kind::structure || type.kind == Kind::array || type.is_instance();
    return has_several && value.kind == E::constant && value.token.text == "0";
}

/// CoDeSys 2.3: `a : ARRAY[1..3] OF INT := 5` is the first element alone, without brackets.
bool is_first_element(const Expression& value, const Type& type) {
    if (type.kind != Kind::array || !value.place.dialect().is_loose) return false;
    const Expression& sign = value.kind == E::unary ? *value.operands[0] : value;
    return value.kind == E::list ? value.is_structure() : sign.kind == E::constant;
}

void check_one(Checking& c, Variable& variable) {
    if (!variable.initial || !variable.type || variable.space == Space::constant) return;
    check_initial(c, variable);
}

void check_own_initials(Checking& c, Routine& routine, std::unordered_set<const Routine*>& done);

/// Those in the blocks that `type` is or has instances of.
void check_initials_within(Checking& c, const Type* type,
                           std::unordered_set<const Routine*>& done) {
    if (!type) return;
    if (type->kind == Kind::array) check_initials_within(c, type->element, done);
    if (type->kind == Kind::structure)
        for (const Variable* member : type->members) check_initials_within(c, member->type, done);
    if (type->kind == Kind::block) check_own_initials(c, *type->routine, done);
}

/// Those of a routine's variables, behind those of its base and of its instances: what runs for
/// these is known then.
void check_own_initials(Checking& c, Routine& routine, std::unordered_set<const Routine*>& done) {
    if (!done.insert(&routine).second) return;
    if (routine.base) check_own_initials(c, *routine.base, done);
    for (const Variable& variable : routine.variables)
        check_initials_within(c, variable.type, done);
    c.routine = &routine;
    // By index: ADR of a constant adds a variable.
    for (std::size_t i = 0; i < routine.variables.size(); ++i) {
        Variable& variable = routine.variables[i];
        if (variable.initial && variable.section == Section::in_out && !is_kept_in_out(variable))
            c.fail(code::wrong_place, variable.name.place, "a VAR_IN_OUT has no initial value",
                   "leave ':= ...' out; the caller gives the variable");
        begin_members(c, variable);
        begin_instance(c, variable);
        check_one(c, variable);
        follow_init(c, variable);
    }
    begin_block(c, routine);
}

}  // namespace

void check_initial_values(Checking& c) {
    const auto is_member = [](const Variable& v) { return v.space == Space::frame && !v.of; };
    for (Variable& variable : c.checked.variables) {
        if (!is_member(variable)) continue;
        const auto routine = c.routines_of_members.find(&variable);
        c.routine = routine == c.routines_of_members.end() ? nullptr : routine->second;
        check_one(c, variable);
    }
    std::unordered_set<const Routine*> done;
    // By index: a block that begins with what runs adds a method.
    for (std::size_t i = 0; i < c.checked.routines.size(); ++i)
        check_own_initials(c, c.checked.routines[i], done);
    c.routine = nullptr;
    for (std::size_t i = 0; i < c.checked.variables.size(); ++i) {
        Variable& variable = c.checked.variables[i];
        begin_members(c, variable);
        begin_instance(c, variable);
        if (!is_member(variable)) check_one(c, variable);
        follow_init(c, variable);
    }
    for (const Global& global : c.checked.globals) check_data_block(c, global);
    c.routine = nullptr;
    give_axes_to_tests(c);
    begin_globals(c);
}

void check_initial(Checking& c, Variable& variable) {
    Expression& written = *variable.initial;
    if (!written.initial) {
        Expression* value = &written;
        const bool is_of_type = !c.routine || c.routines_of_members.contains(&variable);
        const bool begins = variable.space == Space::global || (c.routine && variable.of);
        const Checking::Beginning own{
            .variable = begins ? &variable : nullptr,
            .member = begins || !is_of_type ? nullptr : &variable,
            .is_constructed = begins && begins_by_itself(c, variable.type)};
        Checking::Beginning outer = std::exchange(c.beginning, own);
        if (own.member && begins_by_others(c, variable, value))
            begin_with(c, value, *variable.type);
        else
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
    if (!is_nothing(*value, type) && is_first_element(*value, type)) value = as_elements(c, value);
    if (value->kind == E::list) {
        const Variable* begun = c.beginning.variable;
        if (begun && begun->space == Space::frame)  // the others of its declaration have it, too
            value = make_copy(c, *value);
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
        value = as_elements(c, value);
        return check_initial(c, value, type);
    }
    if (is_nothing(*value, type)) {
        value = make(c, E::list, *value);
        value->token.word = type.kind == Kind::array ? Word::open_bracket : Word::open;
        return check_initial(c, value, type);
    }
    if (is_new(*value) && begin_with(c, value, type)) return;
    if (!check(c, value, &type)) return;
    evaluate(c, value);
    if (!coerce(c, value, type)) return;
    const bool is_constant = evaluate(c, value);
    if (is_constant && !c.beginning.is_constructed) return;
    if (value->type && !begin_with(c, value, type) && !is_constant)
        c.fail(code::not_a_constant, value->place, "an initial value is a constant",
               "assign it in the body, behind IF NOT started");
}

}  // namespace lineshaft::st

#include "runtime/st/check/configuration.hpp"

#include <iterator>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"

namespace lineshaft::st {

namespace {

/// The names of a path: those of members behind an index count, too.
std::size_t count_names(const Expression& e) {
    const std::size_t before = e.operands[0] ? count_names(*e.operands[0]) : 0;
    return before + (e.kind == E::name || e.kind == E::member ? 1 : 0);
}

/// The node of the name with so many names before it.
Expression*& part_behind(Expression*& path, std::size_t count) {
    Expression** at = &path;
    while (count_names(**at) > count + 1 || ((*at)->kind != E::name && (*at)->kind != E::member))
        at = &(*at)->operands[0];
    return *at;
}

/// `R1.P1` of `R1.P1.f.lamp`; empty: it has not so many.
std::string first_names(Expression* path, std::size_t count) {
    if (count_names(*path) < count) return {};
    std::string text;
    for (std::size_t i = 0; i < count; ++i)
        text += (i == 0 ? "" : ".") + std::string(part_behind(path, i)->token.text);
    return text;
}

/// What a path begins with, and how many names that is.
struct Owner {
    const ProgramInstance* instance = nullptr;
    const Pou* program = nullptr;
    std::size_t names = 0;
};

/// A program of the CONFIGURATION by its path, with or without what is around it, else a PROGRAM.
Owner owner_of(const Checking& c, const ConfiguredVariable& given) {
    Expression* path = given.path;
    const auto is_beside = [&](const ProgramInstance& instance) {
        return given.resource.empty() ||
               instance.path.starts_with(fmt::format("{}.", given.resource));
    };
    const auto find = [&](auto path_of) -> Owner {
        for (const ProgramInstance& instance : c.tree.instances) {
            const std::string_view wanted = path_of(instance);
            if (!is_beside(instance)) continue;
            const auto names = static_cast<std::size_t>(std::ranges::count(wanted, '.')) + 1;
            if (same_name(first_names(path, names), wanted)) return {&instance, nullptr, names};
        }
        return {};
    };
    Owner found = find([](const ProgramInstance& i) { return i.whole_path; });
    if (!found.instance) found = find([](const ProgramInstance& i) { return i.path; });
    if (!found.instance) found = find([](const ProgramInstance& i) { return i.name.text; });
    if (found.instance) return found;
    for (const Pou* unit : c.tree.units)
        if (unit->kind == PouKind::program && same_name(first_names(path, 1), unit->name.text))
            return {nullptr, unit, 1};
    return {};
}

/// A number, TRUE or FALSE is left to the program's file, which changes it.
bool is_plain(const Connection& connection) {
    const std::string text = lower(connection.other->place.text());
    const bool is_number = text.find_first_not_of("-.0123456789") == text.npos;
    return !connection.is_output && (is_number || text == "true" || text == "false");
}

Statement* call_of_base(Checking& c, const Token& name) {
    const Expression like{.token = name, .place = name.place};
    return make_call_statement(c, make_call(c, like, make_name(c, like, "super"), {}));
}

void add_program(Checking& c, const ProgramInstance& instance) {
    Pou& pou = c.tree.pous.emplace_back();
    pou.kind = PouKind::program;
    pou.name = instance.name;
    pou.name.text = instance.path;
    pou.place = instance.name.place;
    pou.is_configured = true;
    pou.bases.push_back(instance.type);
    pou.body.push_back(call_of_base(c, instance.name));
    c.tree.units.push_back(&pou);
}

/// The program of a path, whose name goes on within it; null: there is none, which was told.
Routine* take_owner(Checking& c, ConfiguredVariable& given) {
    Expression*& path = given.path;
    const Owner owner = owner_of(c, given);
    const bool is_known = owner.instance || owner.program;
    if (!is_known || count_names(*path) <= owner.names)
        return c.fail(code::not_declared, path->place,
                      is_known ? fmt::format("'{}' is a program", path->place.text())
                               : fmt::format("'{}' is in no program", path->place.text()),
                      is_known ? "name a variable of it behind a '.'"
                               : "begin with the RESOURCE and the program of the CONFIGURATION, or "
                                 "with a PROGRAM");
    Token name = owner.instance ? owner.instance->name : owner.program->name;
    if (owner.instance) name.text = owner.instance->path;
    Expression*& first = part_behind(path, owner.names);
    Expression* own = make_name(c, *first, first->token.text);
    own->token.local = true;
    first = own;
    return c.find_routine(name);
}

/// The variable is in the program's own memory, at a place that is known.
bool is_within(const Expression& place) {
    if (place.variable && place.variable->space != Space::frame) return false;
    const bool is_known = std::ranges::all_of(
        place.arguments, [](const Argument& a) { return a.value->kind == E::constant; });
    const bool is_step = place.kind == E::name || place.kind == E::member || place.kind == E::index;
    return is_known && is_step && (!place.operands[0] || is_within(*place.operands[0]));
}

/// A literal, which means the same wherever it stands.
bool is_literal(const Expression& e) {
    return e.kind == E::constant || (e.kind == E::name && (same_name(e.token.text, "true") ||
                                                           same_name(e.token.text, "false")));
}

/// Copies between the variable and the address at which it stands, as if both were one.
void locate(Checking& c, Routine& routine, const ConfiguredVariable& given, std::string_view name) {
    const Expression& path = *given.path;
    if (given.at.text.ends_with('*'))
        return (void)c.fail(code::not_declared, given.at.place,
                            fmt::format("'{}' is no address", given.at.text),
                            "write which it is: %QX0.3");
    Variable& at = c.make_variable(given.at, name, path.type);
    locate_in_image(c, at, Declaration{.name = given.at, .at = given.at});
    if (!at.type) return;
    using enum ImageAddress::Area;
    const Section pin = path.variable->pin;
    const bool is_input =
        pin == Section::input || (pin == Section::local && at.address.area == input);
    const bool is_other = (pin == Section::input && at.address.area != input) ||
                          (pin == Section::output && at.address.area != output);
    if (is_other)
        c.warn(code::type_does_not_fit, given.at.place,
               fmt::format("'{}' is declared at %{}*, which {} is not", name,
                           pin == Section::input ? 'I' : 'Q', given.at.text),
               "take an address of that area");
    Expression* initial = given.initial ? given.initial : path.variable->initial;
    const bool begins_alike = path.type->is_scalar() && (!initial || is_literal(*initial));
    if (begins_alike) at.initial = initial;
    const auto use = [&] {
        Expression* made = make_use(c, path, at);
        made->type = at.type;
        return made;
    };
    if (is_input || begins_alike)
        routine.before.push_back(make_assignment(c, path.place, given.path, use()));
    if (is_input) return;
    at.is_set = true;
    routine.behind.push_back(make_assignment(c, path.place, use(), given.path));
}

void configure(Checking& c, ConfiguredVariable& given) {
    const std::string_view name = given.path->place.text();
    Routine* routine = take_owner(c, given);
    if (!routine || routine->has_unknown_base) return;
    c.routine = routine;
    const Type* type = check(c, given.path);
    const Type* written = given.type ? resolve(c, *given.type) : nullptr;
    if (!type || (given.type && !written)) return;
    const bool are_texts = written && type->kind == Kind::text && written->kind == Kind::text;
    if (written && !are_texts && !same_type(*type, *written))
        return (void)c.fail(code::type_does_not_fit, given.type->place,
                            fmt::format("'{}' is of {}", name, describe(*type)),
                            "write the type that its declaration has");
    if (!is_within(*given.path))
        return (void)c.fail(code::wrong_place, given.path->place,
                            fmt::format("'{}' is no variable of the program itself", name),
                            "name one of VAR, VAR_INPUT or VAR_OUTPUT, or a part of it");
    if (given.initial) {
        check_initial(c, given.initial, *type);
        routine->initials.push_back(
            make_assignment(c, given.path->place, given.path, given.initial));
    }
    if (given.at.word != Word::end_of_file) locate(c, *routine, given, name);
}

/// What is the program's is looked for in it alone, what it is connected to beside all blocks.
void connect(Checking& c, Routine& routine, Connection& connection) {
    Expression*& first = part_behind(connection.own, 0);
    first = make_name(c, *first, first->token.text);
    first->token.local = true;
    c.routine = &routine;
    const Type* own = check(c, connection.own);
    c.routine = nullptr;
    const Type* other = check(c, connection.other, own);
    if (!own || !other) return;
    const Place place = connection.own->place;
    if (connection.is_output) {
        if (check_target(c, *connection.other) && coerce(c, connection.own, *other))
            routine.behind.push_back(make_assignment(c, place, connection.other, connection.own));
        return;
    }
    if (!coerce(c, connection.other, *own)) return;
    const bool is_constant = evaluate(c, connection.other) && is_within(*connection.own);
    (is_constant ? routine.initials : routine.before)
        .push_back(make_assignment(c, place, connection.own, connection.other));
}

void put_before_returns(Checking& c, Block& block, const Block& behind) {
    for (Statement*& s : block) {
        if (s->kind == S::return_) {
            Block made = behind;
            made.push_back(s);
            s = make_sequence(c, s->place, std::move(made));
            continue;
        }
        for (Branch& branch : s->branches) put_before_returns(c, branch.body, behind);
        put_before_returns(c, s->body, behind);
    }
}

}  // namespace

void add_configured_programs(Checking& c) {
    std::unordered_set<const ProgramInstance*> configured;
    for (const ConfiguredVariable& given : c.tree.configured)
        configured.insert(owner_of(c, given).instance);
    for (const ProgramInstance& instance : c.tree.instances)
        if (configured.contains(&instance) || !std::ranges::all_of(instance.connections, is_plain))
            add_program(c, instance);
}

void configure_programs(Checking& c) {
    for (ProgramInstance& instance : c.tree.instances) {
        Token name = instance.name;
        name.text = instance.path;
        Routine* routine = c.find_routine(name);
        if (!routine || !routine->pou->is_configured || routine->has_unknown_base) continue;
        for (Connection& connection : instance.connections) connect(c, *routine, connection);
    }
    for (ConfiguredVariable& given : c.tree.configured) configure(c, given);
    c.routine = nullptr;
}

void connect(Checking& c, Routine& routine) {
    if (!routine.behind.empty()) put_before_returns(c, routine.body, routine.behind);
    routine.body.insert(routine.body.begin(), routine.before.begin(), routine.before.end());
    routine.body.insert(routine.body.end(), routine.behind.begin(), routine.behind.end());
}

}  // namespace lineshaft::st

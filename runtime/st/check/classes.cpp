#include "runtime/st/check/classes.hpp"

#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/syntax/words.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

/// CODESYS, TwinCAT: what `EXTENDS TON` extends, which is a block of the library with its pins.
Routine* find_extended(Checking& c, Token name) {
    if (!name.place.dialect().is_loose) return nullptr;
    name.text = c.checked.names.emplace_back(
        fmt::format("{}{}", extended_blocks, without_library(name.text)));
    return c.find_routine(name);
}

/// Null where there is none of that name, which was told.
Routine* find_base(Checking& c, const Routine& of, const Token& name, bool wants_interface) {
    const auto fits = [&](const Routine& r) {
        const bool is_program = r.pou->kind == PouKind::program;
        return r.type && r.is_interface() == wants_interface && is_program == of.pou->is_configured;
    };
    Routine* found = c.find_routine(name);
    if (found && fits(*found)) return found;
    if (Routine* extended = wants_interface ? nullptr : find_extended(c, name)) return extended;
    if (c.is_lost(name) || c.tree.lost.contains(name.text) || may_be_elsewhere(c, name.place))
        return nullptr;
    const std::string_view wanted = wants_interface         ? "an interface"
                                    : of.pou->is_configured ? "a PROGRAM"
                                                            : "a function block";
    if (found)
        return c.fail(code::type_does_not_fit, name.place,
                      fmt::format("'{}' is not {}", name.text, wanted),
                      found->is_interface() ? "write IMPLEMENTS" : "");
    std::vector<std::string> names;
    for (const auto& [known, routine] : c.users.routines)
        if (fits(*routine) && routine != &of) names.emplace_back(known);
    std::ranges::sort(names);
    if (c.catalog.find(name.text))
        return c.fail(code::not_supported, name.place,
                      fmt::format("'{}' cannot be extended", name.text),
                      "declare an instance of it, and call that");
    if (c.may_be_foreign(name)) return nullptr;
    return c.fail(code::not_declared, name.place, fmt::format("'{}' is not {}", name.text, wanted),
                  suggest(name.text, names));
}

/// The hops from `from` up to `to`; empty: there is no such way.
std::string hops(const Routine& from, const Routine& to) {
    if (&from == &to) return from.name;
    std::vector<const Routine*> bases(from.interfaces.begin(), from.interfaces.end());
    if (from.base) bases.push_back(from.base);
    for (const Routine* base : bases)
        if (const std::string rest = hops(*base, to); !rest.empty())
            return from.name + " -> " + rest;
    return {};
}

void add_base(Checking& c, Routine& routine, const Token& name, bool wants_interface) {
    Routine* base = find_base(c, routine, name, wants_interface);
    if (!base) {
        routine.has_unknown_base = true;
        return;
    }
    c.note(name.place, *base);
    if (const std::string way = hops(*base, routine); !way.empty())
        return void(
            c.fail(code::contains_itself, name.place,
                   fmt::format("'{}' extends itself: {} -> {}", routine.name, routine.name, way),
                   "let one of them be without a base"));
    if (base->pou->is_final)
        c.fail(code::wrong_place, name.place, fmt::format("{} is FINAL", base->name),
               "declare an instance of it instead, or take FINAL away");
    if (wants_interface)
        routine.interfaces.push_back(base);
    else
        routine.base = base;
}

void replace(Checking& c, Routine& method, Routine& replaced) {
    method.overrides = &replaced;
    for (Routine* r = &replaced; r; r = r->overrides) r->is_replaced = r->is_dispatched = true;
    method.is_dispatched = true;
    if (replaced.pou->is_final)
        c.fail(code::wrong_place, method.pou->name.place, fmt::format("{} is FINAL", replaced.name),
               "give it another name");
}

/// A method without OVERRIDE, whose arguments are not those of the base's, stands beside that, if
/// that has a body; in CODESYS, which has no such word, it is meant to replace it.
bool is_beside(const Routine& method, const Routine& of_base) {
    return &method != &of_base && !method.pou->is_override && !of_base.pou->is_abstract &&
           !of_base.owner->is_interface() && method.pou->accessor == Accessor::none &&
           !method.pou->name.place.dialect().is_loose &&
           signature_of(*method.pou) != signature_of(*of_base.pou);
}

/// What a base has under names that either of them overloads, if it was not replaced.
void inherit_overloads(Routine& block, const Routine& base) {
    for (const auto& [name, first] : base.methods) {
        const auto own = block.methods.find(name);
        const auto theirs = base.overloads.find(name);
        const bool is_hidden = own != block.methods.end() && is_beside(*own->second, *first);
        const bool is_one =
            theirs == base.overloads.end() && !block.overloads.contains(name) && !is_hidden;
        if (is_one) continue;
        auto& all = block.overloads[name];
        if (all.empty() && own != block.methods.end()) all.push_back(own->second);
        const std::vector<Routine*> given =
            theirs == base.overloads.end() ? std::vector{first} : theirs->second;
        for (Routine* method : given) {
            const auto replaces = [&](const Routine* r) {
                return r == method || r->overrides == method;
            };
            if (std::ranges::none_of(all, replaces)) all.push_back(method);
        }
    }
}

/// `seen`: those that are linked.
void link_methods(Checking& c, Routine& block, std::unordered_set<const Routine*>& seen) {
    if (!block.type || !seen.insert(&block).second) return;
    std::vector<Routine*> bases;
    if (block.base) bases.push_back(block.base);
    if (block.is_interface())
        bases.insert(bases.end(), block.interfaces.begin(), block.interfaces.end());
    for (Routine* base : bases) link_methods(c, *base, seen);
    if (block.base)
        for (Routine* r = block.base; r; r = r->base) r->is_replaced = true;
    for (const Routine* base : bases) block.has_unknown_base |= base->has_unknown_base;
    for (Routine* method : block.own_methods) {
        for (Routine* base : bases)
            if (Routine* replaced = find_method(*base, *method);
                replaced && !is_beside(*method, *replaced))
                replace(c, *method, *replaced);
        if (method->pou->is_override && !method->overrides && !block.has_unknown_base &&
            block.interfaces.empty())
            c.fail(code::not_declared, method->pou->name.place,
                   fmt::format("{} overrides nothing", method->name),
                   "no base has a method of that name: leave OVERRIDE out");
    }
    for (const Routine* base : bases) {
        inherit_overloads(block, *base);
        for (auto member : {&Routine::methods, &Routine::getters, &Routine::setters})
            (block.*member).insert((base->*member).begin(), (base->*member).end());
    }
}

std::vector<const Variable*> parameters(const Routine& method) {
    std::vector<const Variable*> found;
    for (const Section section : {Section::input, Section::in_out, Section::output})
        for (const Variable& variable : method.variables)
            if (variable.section == section) found.push_back(&variable);
    return found;
}

/// Empty: they are called alike.
std::string difference(const Routine& a, const Routine& b) {
    const auto type_of = [](const Routine& r) { return r.result ? r.result->type : nullptr; };
    const Type *result_a = type_of(a), *result_b = type_of(b);
    if (!a.result != !b.result || (result_a && result_b && !same_type(*result_a, *result_b)))
        return "another result";
    const auto of_a = parameters(a), of_b = parameters(b);
    if (of_a.size() != of_b.size())
        return fmt::format("{} argument{}, not {}", of_a.size(), of_a.size() == 1 ? "" : "s",
                           of_b.size());
    for (std::size_t i = 0; i < of_a.size(); ++i) {
        const Variable &x = *of_a[i], &y = *of_b[i];
        if (!same_name(x.text, y.text) || x.section != y.section)
            return fmt::format("the argument '{}', not '{}'", x.text, y.text);
        if (x.type && y.type && !same_type(*x.type, *y.type))
            return fmt::format("'{}' as {}, not {}", x.text, describe(*x.type), describe(*y.type));
    }
    return {};
}

void check_signature(Checking& c, const Routine& method, const Routine& wanted) {
    const std::string other = difference(method, wanted);
    if (other.empty()) return;
    c.fail(code::wrong_arguments, method.pou->name.place,
           fmt::format("{} has {}, as {} has", method.name, other, wanted.name),
           fmt::format("declare it as in line {}", wanted.pou->name.place.mark().line));
}

/// All methods of an interface with those of its bases.
void collect(const Routine& interface, std::vector<Routine*>& to) {
    for (const Routine* base : interface.interfaces) collect(*base, to);
    to.insert(to.end(), interface.own_methods.begin(), interface.own_methods.end());
}

std::string shown_name(const Routine& method) {
    const Accessor accessor = method.pou->accessor;
    return fmt::format("{}{}", method.pou->name.text,
                       accessor == Accessor::get   ? " (GET)"
                       : accessor == Accessor::set ? " (SET)"
                                                   : "");
}

/// CODESYS, TwinCAT: what every block has without writing it.
bool is_implicit(const Routine& method) {
    constexpr std::string_view all[] = {"fb_init", "fb_exit", "fb_reinit"};
    return method.pou->name.place.dialect().is_loose && find_called(all, method.pou->name.text);
}

void check_interfaces(Checking& c, Routine& block) {
    for (std::size_t i = 0; i < block.interfaces.size(); ++i) {
        std::vector<Routine*> wanted;
        collect(*block.interfaces[i], wanted);
        std::vector<std::string> lacking;
        for (Routine* method : wanted) {
            method->is_dispatched = true;
            Routine* found = find_method(block, *method);
            if (!found && is_implicit(*method)) continue;
            if (!found) {
                if (std::ranges::find(lacking, shown_name(*method)) == lacking.end())
                    lacking.push_back(shown_name(*method));
                continue;
            }
            for (Routine* r = found; r; r = r->overrides) r->is_dispatched = true;
            check_signature(c, *found, *method);
        }
        if (lacking.empty() || block.has_unknown_base || block.pou->is_abstract) continue;
        c.fail(code::not_declared, block.pou->implemented[i].place,
               fmt::format("{} lacks of {}: {}", block.name, block.interfaces[i]->name,
                           fmt::join(lacking, ", ")),
               "write these methods");
    }
}

void check_abstract(Checking& c, const Routine& block) {
    std::vector<std::string> open;
    for (const auto member : {&Routine::methods, &Routine::getters, &Routine::setters})
        for (const auto& [name, method] : block.*member)
            if (method->pou->is_abstract) open.push_back(method->name);
    std::ranges::sort(open);
    if (open.empty() || block.pou->is_abstract || block.has_unknown_base) return;
    c.fail(code::wrong_place, block.pou->name.place,
           fmt::format("{} has no body for {}", block.name, fmt::join(open, ", ")),
           "write these methods, or make the block ABSTRACT");
}

std::string_view namespace_of(const Routine& block) {
    const std::size_t point = block.name.rfind('.');
    return std::string_view(block.name).substr(0, point == std::string::npos ? 0 : point);
}

/// The namespace itself, or one in it.
bool is_within_namespace(std::string_view path, std::string_view outer) {
    return same_name(path.substr(0, outer.size()), outer) &&
           (path.size() == outer.size() || path[outer.size()] == '.');
}

}  // namespace

const Routine* own_block(const Checking& c) {
    if (!c.routine) return nullptr;
    const Routine* block = c.routine->owner ? c.routine->owner : c.routine;
    return block->type && !block->pou->is_tests ? block : nullptr;
}

void resolve_bases(Checking& c) {
    for (Routine& routine : c.checked.routines) {
        if (!routine.type) continue;
        const bool is_interface = routine.is_interface();
        const auto own = [&](const Token& name) { return without_project(c, name).value_or(name); };
        for (const Token& name : routine.pou->bases) add_base(c, routine, own(name), is_interface);
        for (const Token& name : routine.pou->implemented) add_base(c, routine, own(name), true);
    }
    std::unordered_set<const Routine*> seen;
    for (Routine& routine : c.checked.routines) link_methods(c, routine, seen);
}

void inherit_variables(Routine& block) {
    if (block.base) block.names.insert(block.base->names.begin(), block.base->names.end());
}

void check_classes(Checking& c) {
    for (Routine& routine : c.checked.routines) {
        const bool is_constructor = same_name(routine.pou->name.text, "fb_init");
        if (routine.overrides && !is_constructor) check_signature(c, routine, *routine.overrides);
        if (!routine.type || routine.is_interface()) continue;
        check_interfaces(c, routine);
        check_abstract(c, routine);
        if (routine.pou->is_class && !routine.pou->body.empty())
            c.fail(code::wrong_place, routine.pou->body.front()->place, "a CLASS has no body",
                   "write a METHOD, or make it a FUNCTION_BLOCK");
    }
}

void refuse_abstract(Checking& c, const Type* type, Place place) {
    while (type && type->kind == Kind::array) type = type->element;
    if (!type || type->kind != Kind::block || !type->routine->pou->is_abstract) return;
    c.fail(code::wrong_place, place, fmt::format("{} is ABSTRACT: it has no instances", type->name),
           "declare one of a block that extends it");
}

bool is_own_instance(Checking& c, const Expression& e) {
    const bool is_word = e.kind == E::name && !e.token.local && !e.token.quoted && own_block(c) &&
                         (same_name(e.token.text, "this") || same_name(e.token.text, "super"));
    return is_word && !find_variable(c, e.token);
}

const Type* check_own_instance(Checking& c, Expression*& e) {
    const Routine& block = *own_block(c);
    const bool is_super = same_name(e->token.text, "super");
    if (is_super && block.has_unknown_base) return nullptr;
    if (is_super && !block.base)
        return c.fail(code::not_declared, e->place, fmt::format("{} has no base", block.name),
                      "write EXTENDS behind its name");
    e = make(c, E::self, *e);
    return e->type = is_super ? block.base->type : block.type;
}

bool is_accessible(Checking& c, Access access, const Routine& owner, const Token& name) {
    const Routine* own = own_block(c);
    if (c.is_in_test() || own == &owner) return true;
    const auto refuse = [&](std::string_view word, std::string_view who) {
        return c.fail(code::wrong_arguments, name.place,
                      fmt::format("'{}' is {} to {}", name.text, word, owner.name),
                      std::string(who));
    };
    if (access == Access::private_) return refuse("PRIVATE", "only its own block calls it");
    if (access == Access::protected_ && !(own && is_a(*own, owner)))
        return refuse("PROTECTED", "only its own block and those that extend it name it");
    const Routine* user = own ? own : c.routine;
    const std::string_view inside = namespace_of(owner);
    const bool is_within = user && is_within_namespace(namespace_of(*user), inside);
    if (access == Access::internal_ && !is_within && !inside.empty())
        return refuse("INTERNAL", "only its own namespace names it");
    return true;
}

bool may_be_derived(const Expression& receiver) {
    if (receiver.kind == E::self) return !same_name(receiver.token.text, "super");
    if (receiver.kind == E::deref) return true;
    const bool is_place = receiver.kind == E::name || receiver.kind == E::member;
    return is_place && receiver.variable && receiver.variable->space == Space::reference;
}

bool is_through_reference(const Expression& call) {
    const Expression* at = call.operands[0];
    const bool is_instance = at->type && at->type->kind == Kind::block;
    if (!is_instance && at->kind != E::member) return false;
    if (!is_instance) at = at->operands[0];
    while (at->kind == E::index || (at->kind == E::member && !may_be_derived(*at)))
        at = at->operands[0];
    return at->kind != E::self && may_be_derived(*at);
}

const Type* check_method_call(Checking& c, Expression*& call, Routine& method,
                              const Expression& receiver, bool as_statement) {
    const bool through =
        method.owner->is_interface() || (receiver.type && receiver.type->kind == Kind::interface);
    call->is_dispatched = through || (method.is_replaced && may_be_derived(receiver));
    if (method.pou->is_abstract && !call->is_dispatched && !may_be_derived(receiver))
        return c.fail(code::wrong_place, call->place,
                      fmt::format("{} is ABSTRACT: it has no body", method.name),
                      "call it where a block that extends this one has written it");
    return check_routine_call(c, call, method, as_statement);
}

Routine* find_accessor(Checking& c, const Expression& e, Accessor accessor) {
    const auto in = [&](const Routine& block) -> Routine* {
        return find_in(accessor == Accessor::get ? block.getters : block.setters, e.token.text);
    };
    if (e.kind == E::member) {
        const Type* of = e.operands[0]->type;
        if (!of || !of->routine) return nullptr;
        return in(*of->routine);
    }
    const Routine* block = own_block(c);
    if (e.kind != E::name || !block || e.token.local || e.token.quoted) return nullptr;
    return is_own_variable(c, e.token) ? nullptr : in(*block);
}

/// What stands before the point of a call of a PROPERTY's method, or THIS.
static const Expression& receiver_of(Checking& c, const Expression& property) {
    if (property.kind == E::member) return *property.operands[0];
    Expression* own = make_name(c, property, "this");
    own->kind = E::self;
    return *own;
}

const Type* check_getter(Checking& c, Expression*& e, Routine& getter) {
    if (!is_accessible(c, getter.pou->access, *getter.owner, e->token)) return nullptr;
    const Expression& receiver = receiver_of(c, *e);
    e = make_call(c, *e, e, {});
    return e->type = check_method_call(c, e, getter, receiver, false);
}

/// A REFERENCE TO is given by REF= alone, to SET; else what GET refers to is assigned.
static bool is_written_through(const Statement& s, const Routine* getter) {
    const Type* type = getter && getter->result ? getter->result->type : nullptr;
    return type && type->is_alias() && s.op != Word::reference_assign;
}

/// `got REF= property; got := value;`
static void write_through(Checking& c, Statement*& s, const Type& type) {
    Variable& got = c.make_variable(*c.routine, s->target->token, "GET", &type);
    Statement* first = make_assignment(c, s->place, make_use(c, *s->target, got), s->target);
    first->op = Word::reference_assign;
    Statement* then = make_assignment(c, s->place, make_use(c, *s->target, got), s->value);
    then->op = s->op;
    s = make_sequence(c, s->place, {first, then});
    check(c, s);
}

/// `Space.Block` in `Space.Block.member := value;`; a variable's full name is none.
static bool is_type_or_routine(Checking& c, const Expression& e) {
    const auto full = e.kind == E::member ? qualified_name(c, e) : std::nullopt;
    return full && !find_variable(c, *full);
}

bool rewrite_property(Checking& c, Statement*& s) {
    Expression* target = s->target;
    if (target->kind == E::member) {
        name_block_of_list(c, *target);
        if (qualified_name(c, *target) || enumeration_of(c, *target)) return false;
        if (is_type_or_routine(c, *target->operands[0])) return false;
        if (refuse_member_of_namespace(c, *target) || refuse_of_list(c, *target)) return true;
        if (!check(c, target->operands[0])) return true;
    } else if (target->kind != E::name || target->variable) {
        return false;
    }
    const Routine* getter = find_accessor(c, *target, Accessor::get);
    if (is_written_through(*s, getter)) {
        write_through(c, s, *getter->result->type);
        return true;
    }
    Routine* setter = find_accessor(c, *target, Accessor::set);
    if (!setter) {
        if (!getter) return false;
        c.fail(code::cannot_be_assigned, target->place,
               fmt::format("the property '{}' has no SET", target->token.text), "it is only read");
        return true;
    }
    if (!is_accessible(c, setter->pou->access, *setter->owner, target->token)) return true;
    Expression* named = make_copy(c, *target);  // others may have the statement, too: make_copies
    const Expression& receiver = receiver_of(c, *named);
    Expression* value = s->value;
    if (s->op != Word::assign && s->op != Word::reference_assign)
        value =
            make_binary(c, s->place, s->place, operator_of(s->op), make_copy(c, *target), value);
    Expression* call = make_call(c, *target, named, {{.value = value}});
    check_method_call(c, call, *setter, receiver, true);
    s = make_call_statement(c, call);
    return true;
}

}  // namespace lineshaft::st

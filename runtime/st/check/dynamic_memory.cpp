#include "runtime/st/check/dynamic_memory.hpp"

#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"

namespace lineshaft::st {

namespace {

/// About so many slots of memory as one takes.
std::uint64_t slots_of_one(const Type& type) {
    constexpr std::uint64_t of_any_block = 16, of_a_reference = 3;
    const auto of_all = [](const auto& variables) {
        std::uint64_t slots = 0;
        for (const Variable* variable : variables)
            if (variable->type) slots += slots_of_one(*variable->type);
        return slots;
    };
    if (type.kind == Kind::array) return type.count() * slots_of_one(*type.element);
    if (type.kind == Kind::text) return 1 + type.length / 8;
    if (type.kind == Kind::structure || type.kind == Kind::union_) return of_all(type.members);
    if (type.kind == Kind::block) return of_any_block + of_all(all_variables(*type.routine));
    if (type.kind == Kind::standard) return type.standard->size / 8;
    return type.is_reference() || type.kind == Kind::interface ? of_a_reference : 1;
}

/// Half a megabyte of a type, at least 64.
std::int64_t size_of_pool(const Type& type) {
    constexpr std::uint64_t slots = 1U << 16, fewest = 64;
    const std::uint64_t one = std::max<std::uint64_t>(slots_of_one(type), 1);
    return static_cast<std::int64_t>(std::max(slots / one, fewest));
}

Variable& add_to_statics(Checking& c, const Expression& like, std::string name, const Type& of,
                         std::int64_t count) {
    Type& array = c.make_type(Kind::array, {});
    array.element = &of;
    array.upper = count - 1;
    Variable& made =
        c.make_variable(like.token, c.checked.names.emplace_back(std::move(name)), &array);
    made.used = true;
    keep_once(c, made);
    return made;
}

Checking::Pool& pool_of(Checking& c, const Expression& like, const Type& type) {
    for (Checking::Pool& pool : c.pools)
        if (same_type(*pool.type, type)) return pool;
    const std::int64_t size = size_of_pool(type);
    const std::string name = fmt::format("__NEW({})", describe(type));
    Checking::Pool& made = c.pools.emplace_back();
    made.type = &type;
    made.elements = &add_to_statics(c, like, name, type, size + 1);
    made.taken = &add_to_statics(c, like, name + " taken", dint_type, size + 1);
    return made;
}

Expression* element(Checking& c, const Expression& like, Variable& array, Expression* index) {
    Expression* made = make(c, E::index, like);
    made->operands[0] = make_use(c, like, array);
    made->arguments.push_back({.value = index});
    return made;
}

/// As who has a pointer to it names it: what its methods call may lead back here.
Expression* instance(Checking& c, const Expression& like, Variable& array, Expression* index) {
    Expression* place = element(c, like, array, index);
    return array.type->element->kind == Kind::block
               ? make_target(c, like, make_call(c, "__SYSTEM.ADR", place), nullptr)
               : place;
}

Expression* null(Checking& c, const Expression& like) {
    return make_constant(c, like, null_type, {});
}

Expression* binary(Checking& c, const Expression& like, Word op, Expression* left,
                   Expression* right) {
    return make_binary(c, like.place, like.place, op, left, right);
}

/// `FOR counter := first TO last DO body END_FOR`
Statement* make_for(Checking& c, const Expression& like, Variable& counter, Expression* first,
                    Expression* last, Block body) {
    Statement* loop = make_assignment(c, like.place, make_use(c, like, counter), first);
    loop->kind = S::for_;
    loop->limit = last;
    loop->body = std::move(body);
    return loop;
}

Expression* system_call(Checking& c, const Expression& like, std::string_view function,
                        std::string_view input, Expression* value, Variable& taken) {
    const auto named = [&](std::string_view name) {
        Token token = like.token;
        token.word = Word::name;
        token.text = name;
        return token;
    };
    return make_call(c, like, make_name(c, like, function),
                     {{.name = named(input), .value = value},
                      {.name = named("taken"), .value = make_use(c, like, taken)}});
}

/// How a new one begins, in statements: as its type says, then FB_init is called.
Block begin_elements(Checking& c, const Expression& like, Checking::Pool& pool, Variable& first,
                     Variable& counter, Expression* count, const std::vector<Argument>* values) {
    const Type& type = *pool.type;
    Block body;
    const auto at_counter = [&] {
        return element(c, like, *pool.elements, make_use(c, like, counter));
    };
    Statement* renewal =
        make_assignment(c, like.place, at_counter(),
                        element(c, like, *pool.elements, make_dint(c, like, size_of_pool(type))));
    c.renewals.insert(renewal);
    body.push_back(renewal);
    const auto made = [&] { return instance(c, like, *pool.elements, make_use(c, like, counter)); };
    construct_one(c, like, *c.routine, type, values, made, body);
    Expression* last = binary(c, like, Word::plus, make_use(c, like, first), count);
    return {make_for(c, like, counter, make_use(c, like, first),
                     binary(c, like, Word::minus, last, make_dint(c, like, 1)), std::move(body))};
}

bool is_interface(Checking& c, const Expression& target) {
    Expression* own = make_copy(c, target);
    const Type* type = check(c, own);
    return type && type->kind == Kind::interface;
}

bool is_call_of(const Statement& s, std::string_view name) {
    return s.value && s.value->kind == E::call && s.value->operands[0]->kind == E::name &&
           same_name(s.value->operands[0]->token.text, name);
}

/// What is deleted may be an element of that pool.
bool may_be_of(const Type& pointer, const Type& pool) {
    const Type& target = *pointer.element;
    if (same_type(target, pool)) return true;
    if (target.is_bits()) return packed_bits(pool, iec) > 0;
    return target.kind == Kind::block && pool.kind == Kind::block &&
           is_a(*pool.routine, *target.routine);
}

/// FB_exit of those that begin at `first`, if their block has one.
Block end_elements(Checking& c, const Expression& like, Checking::Pool& pool, Variable& first,
                   Variable& counter) {
    const Type& type = *pool.type;
    const Routine* exit =
        type.kind == Kind::block ? find_in(type.routine->methods, "fb_exit") : nullptr;
    if (!exit) return {};
    Expression* ended = instance(c, like, *pool.elements, make_use(c, like, counter));
    Statement* call =
        make_call_statement(c, make_call(c, like, make_member(c, ended, exit->pou->name.text),
                                         {{.value = make_boolean(c, like, false)}}));
    Expression* behind = binary(c, like, Word::plus, make_use(c, like, first),
                                element(c, like, *pool.taken, make_use(c, like, first)));
    return {make_for(c, like, counter, make_use(c, like, first),
                     binary(c, like, Word::minus, behind, make_dint(c, like, 1)), {call})};
}

/// `IF taken[i] > 0 AND_THEN p = ADR(elements[i]) THEN` calls FB_exit and gives them back.
Statement* delete_of(Checking& c, const Checking::Deletion& deletion, Checking::Pool& pool,
                     Variable& counter, Variable& inner) {
    const Expression& like = *deletion.statement->value;
    const auto place = [&] { return element(c, like, *pool.elements, make_use(c, like, counter)); };
    Expression* is_taken =
        binary(c, like, Word::greater, element(c, like, *pool.taken, make_use(c, like, counter)),
               make_dint(c, like, 0));
    Expression* is_it = binary(c, like, Word::equal, make_copy(c, *deletion.pointer),
                               make_call(c, "__SYSTEM.ADR", place()));
    Block body = end_elements(c, like, pool, counter, inner);
    body.push_back(make_call_statement(c, system_call(c, like, "__SYSTEM.__DELETE", "first",
                                                      make_use(c, like, counter), *pool.taken)));
    body.push_back(make_exit(c, like.place));
    return make_for(c, like, counter, make_dint(c, like, 0),
                    make_dint(c, like, size_of_pool(*pool.type) - 1),
                    {make_if(c, like.place, binary(c, like, Word::and_then_, is_taken, is_it),
                             std::move(body), {})});
}

/// A block that has no FB_init, but for the one of all blocks. What keeps values over a restart,
/// is its own block or may be of another that extends it has none.
bool may_begin_anew(const Checking& c, const Expression& call, const Type* type) {
    if (!type || type->kind != Kind::block || is_through_reference(call)) return false;
    const Routine& block = *type->routine;
    const auto is_kept = [](const Variable& variable) {
        return variable.retention == Retention::retain;
    };
    return !block.methods.contains("fb_init") && &block != c.routine &&
           &block != c.routine->owner && std::ranges::none_of(block.variables, is_kept);
}

/// Whether values that are kept and an online change are meant counts for nothing then.
bool are_arguments_of_init(Checking& c, Expression& call) {
    if (call.arguments.size() != 2)
        return c.fail(code::wrong_arguments, call.place, "FB_init takes 2 arguments",
                      "bInitRetains and bInCopyCode");
    for (Argument& argument : call.arguments) {
        if (!check(c, argument.value, &bool_type) || !coerce(c, argument.value, bool_type))
            return false;
    }
    return true;
}

}  // namespace

bool is_of_dynamic_memory(std::string_view function) {
    return same_name(function, "__new") || same_name(function, "__delete");
}

bool is_new(const Expression& value) {
    return value.kind == E::call && value.operands[0]->kind == E::name &&
           same_name(value.operands[0]->token.text, "__new");
}

bool rewrite_new(Checking& c, Statement*& s) {
    if (s->kind != S::assign || s->op != Word::assign) return false;
    if (!s->value || !is_new(*s->value)) return false;
    Expression& call = *s->value;
    const Type* type = resolve(c, *call.of);
    if (!type) return check(c, s->target), true;
    const std::vector<Argument>* values = constructor_arguments(call.of, type);
    if (values && !values->empty() && !has_constructor(c, type)) {
        refuse_constructor_arguments(c, call.of->place, *type);
        return true;
    }
    const Expression& like = *call.operands[0];
    Checking::Pool& pool = pool_of(c, like, *type);
    const auto variable = [&](std::string_view name, const Type& of) -> Variable& {
        return c.make_variable(*c.routine, like.token, name, &of);
    };
    Variable &count = variable("__NEW.count", dint_type),
             &first = variable("__NEW.first", dint_type),
             &counter = variable("__NEW.counter", dint_type),
             &pointer = variable("__NEW.pointer", pointer_to(c, *type));
    Expression* given = call.arguments.empty()
                            ? make_dint(c, like, 1)
                            : make_call(c, "__SYSTEM.TO_DINT", call.arguments[0].value);
    Block then = begin_elements(c, like, pool, first, counter, make_use(c, like, count), values);
    then.push_back(make_assignment(
        c, s->place, make_use(c, like, pointer),
        make_call(c, "__SYSTEM.ADR", element(c, like, *pool.elements, make_use(c, like, first)))));
    Expression* is_made =
        binary(c, like, Word::greater_or_equal, make_use(c, like, first), make_dint(c, like, 0));
    const auto take = [&](Expression* made) {
        Statement* assigned = make_assignment(c, s->place, s->target, made);
        if (c.beginnings.contains(s)) c.beginnings.insert(assigned);
        return assigned;
    };
    Block otherwise, behind;
    if (is_interface(c, *s->target)) {
        Expression* instance = make(c, E::deref, like);
        instance->operands[0] = make_use(c, like, pointer);
        Expression* none = make_constant(c, like, any_integer_type, {});
        then.push_back(take(instance));
        otherwise.push_back(take(none));
    } else {
        behind.push_back(take(make_use(c, like, pointer)));
    }
    Block all{make_assignment(c, s->place, make_use(c, like, count), given),
              make_assignment(c, s->place, make_use(c, like, first),
                              system_call(c, like, "__SYSTEM.__NEW", "count",
                                          make_use(c, like, count), *pool.taken)),
              make_assignment(c, s->place, make_use(c, like, pointer), null(c, like)),
              make_if(c, s->place, is_made, std::move(then), std::move(otherwise))};
    std::ranges::move(behind, std::back_inserter(all));
    s = make_sequence(c, s->place, std::move(all));
    check(c, s);
    return true;
}

bool rewrite_delete(Checking& c, Statement*& s) {
    if (s->kind != S::call || !is_call_of(*s, "__delete")) return false;
    Expression& call = *s->value;
    if (call.arguments.size() != 1 || call.arguments[0].is_output)
        return c.fail(code::wrong_arguments, call.place, "__DELETE takes 1 argument"), true;
    Expression* pointer = call.arguments[0].value;
    const Type* type = check(c, pointer);
    if (!type) return true;
    if (pointer->kind == E::self && !coerce(c, pointer, pointer_to(c, *type))) return true;
    type = pointer->type;
    if (!type->is_pointer() || !type->element) {
        c.fail(code::type_does_not_fit, pointer->place,
               fmt::format("__DELETE takes a POINTER TO, not {}", describe(*type)),
               "give it what __NEW was assigned to");
        return true;
    }
    Statement* made = make_sequence(c, s->place, {});
    made->value = &call;
    c.deletions.push_back({c.routine, made, pointer});
    s = made;
    return true;
}

bool rewrite_init(Checking& c, Statement*& s) {
    Expression& call = *s->value;
    const Expression& callee = *call.operands[0];
    const bool is_init = s->kind == S::call && s->place.dialect().is_loose && c.routine &&
                         callee.kind == E::member && same_name(callee.token.text, "fb_init");
    if (!is_init || refuse_member_of_namespace(c, callee)) return false;
    const Type* type = check(c, call.operands[0]->operands[0]);
    if (!may_begin_anew(c, call, type)) return false;
    if (!are_arguments_of_init(c, call)) return true;
    const Expression& like = *callee.operands[0];
    const auto instance = [&] { return make_copy(c, like); };
    Variable& untouched = c.make_variable(*c.routine, callee.token, "FB_init.untouched", type);
    Block all{make_assignment(c, s->place, instance(), make_use(c, like, untouched))};
    c.renewals.insert(all.front());
    if (is_constructed(c, type)) construct_one(c, like, *c.routine, *type, nullptr, instance, all);
    s = make_sequence(c, s->place, std::move(all));
    check(c, s);
    return true;
}

void write_deletions(Checking& c) {
    for (const Checking::Deletion& deletion : c.deletions) {
        c.routine = deletion.routine;
        const Expression& like = *deletion.statement->value;
        const auto variable = [&](std::string_view name) -> Variable& {
            return c.make_variable(*c.routine, like.operands[0]->token, name, &dint_type);
        };
        Variable &counter = variable("__DELETE.counter"), &inner = variable("__DELETE.inner");
        Block& body = deletion.statement->body;
        for (Checking::Pool& pool : c.pools)
            if (may_be_of(*deletion.pointer->type, *pool.type))
                body.push_back(delete_of(c, deletion, pool, counter, inner));
        if (is_place(*deletion.pointer))
            body.push_back(
                make_assignment(c, deletion.statement->place, deletion.pointer, null(c, like)));
        for (Statement*& statement : body) check(c, statement);
    }
    c.routine = nullptr;
}

}  // namespace lineshaft::st

#include "runtime/st/check/references.hpp"

#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/open_arrays.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/code/addresses.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

Type& make_reference(Checking& c, Referring referring, const Type* target) {
    constexpr std::uint32_t slots = 3;
    Type& type = c.make_type(Kind::reference, {});
    type.slots = slots;
    type.referring = referring;
    type.element = target;
    return type;
}

Expression*& without_alias(Expression*& e) {
    const bool is_alias = e->kind == E::deref && e->operands[0]->type->is_alias();
    return is_alias ? e->operands[0] : e;
}

namespace {

bool is_null(const Expression& e) {
    const bool is_number =
        is_constant(e) && (e.type->kind == Kind::any_integer || e.type->kind == Kind::any_bits);
    return e.type == &null_type || (is_number && e.constant.integer == 0);
}

/// What cannot be referred to; empty if it can. A POINTER TO may point at an array or a structure
/// of VAR CONSTANT.
std::string_view why_no_place(const Expression& e, bool is_pointer) {
    if (e.kind == E::constant)
        return e.variable ? "a constant has no place" : "a value has no place";
    if (e.kind == E::bit || e.is_character()) return "a part of a value has no place of its own";
    if (e.kind == E::self) return {};
    if (e.kind != E::name && e.kind != E::member && e.kind != E::index && e.kind != E::deref)
        return "a value has no place";
    const Expression& root = root_of(e);
    if (root.variable && root.variable->space == Space::image) {
        if (root.variable->address.bits == 1) return "a bit at an address has no place of its own";
        if (e.place.dialect().packs_as_s7) return "what stands at an address is not referred to";
    }
    if (root.kind == E::deref) return {};
    if (root.kind != E::name && root.kind != E::member) return "a value has no place";
    if (root.variable && root.variable->constant && !is_pointer) return "a constant has no place";
    const bool is_standard =
        root.kind == E::member && root.operands[0]->type->kind == Kind::standard;
    const bool is_value = e.type->is_scalar() && e.type->kind != Kind::enumeration;
    if ((is_standard && !is_value) || e.type->is_object())
        return "that part of a standard block cannot be referred to";
    return {};
}

/// That of its variable, as no source has one.
std::string_view name_of_literal(Checking& c, const Routine& routine) {
    return c.checked.names.emplace_back(
        fmt::format("{} literal {}", routine.name, c.checked.variables.size()));
}

/// A constant scalar that a POINTER TO is to point at, or a text, stands in its block once more, as
/// a variable. A text of a call stays when that has ended.
void keep_constant(Checking& c, Expression*& e) {
    const bool is_text = !e->variable && e->type->kind == Kind::text;
    if (e->kind != E::constant || (!e->variable && !is_text)) return;
    Routine* routine = c.routine;
    while (routine && !is_text && routine->pou != e->variable->of) routine = routine->owner;
    if (!routine) return;
    const bool is_static = is_text && !routine->has_instances() && !routine->is_test();
    Variable& kept = is_static
                         ? c.make_variable(e->token, name_of_literal(c, *routine), e->type)
                         : c.make_variable(*routine, e->token,
                                           is_text ? e->token.text : e->variable->text, e->type);
    if (is_static) keep_once(c, kept);
    kept.initial = is_text ? e : e->variable->initial;
    e = make_use(c, *e, kept);
}

/// Its first element or member, or that one's, is of the type: a pointer to the one is one to the
/// other.
bool begins_with(const Type& whole, const Type& part) {
    if (same_type(whole, part)) return true;
    if (whole.kind == Kind::array) return whole.element && begins_with(*whole.element, part);
    if (whole.kind != Kind::structure || whole.members.empty()) return false;
    const Type* first = whole.members.front()->type;
    return first && begins_with(*first, part);
}

/// No part of it is an instance, whose bytes nobody sees.
bool is_of_bytes(const Type& type) {
    if (type.kind == Kind::array) return type.element && is_of_bytes(*type.element);
    if (type.kind == Kind::structure)
        return std::ranges::all_of(type.members, [](const Variable* member) {
            return member->type && is_of_bytes(*member->type);
        });
    return !type.is_instance() && type.kind != Kind::handle;
}

/// An instance of a block that derives from the one that is referred to is one of it, too.
bool is_target(const Type& reference, const Type& given) {
    if (!reference.element) return false;
    const Type& wanted = *reference.element;
    const bool derives = wanted.kind == Kind::block && given.kind == Kind::block &&
                         is_a(*given.routine, *wanted.routine);
    return derives || same_type(wanted, given);
}

/// A global that the program's addresses are kept in, and their numbers.
Variable& make_known(Checking& c, const Token& like, std::string_view name, const Type& element,
                     std::uint32_t count) {
    Type& array = c.make_type(Kind::array, {});
    array.element = &element;
    array.upper = std::int64_t{count} - 1;
    Variable& made = c.make_variable(like, name, &array);
    made.used = true;
    keep_once(c, made);
    return made;
}

/// A POINTER becomes a number, or a number one.
const Type* convert_address(Checking& c, Expression*& e, const Type& to) {
    if (!c.checked.numbered) {
        c.checked.has_references = true;
        c.checked.numbered =
            &make_known(c, e->token, "ADR", pointer_to(c, bits_type(8)), numbered_places);
        c.checked.numbers =
            &make_known(c, e->token, "ADR.numbers", bits_type(64), slots_of_numbers);
    }
    return become_converted(c, e, to);
}

bool refuse_target(Checking& c, const Expression& e, const Type& to, const Type& from) {
    std::string help = "write '^' behind it: what it refers to";
    if (to.is_integer() || to.is_bits())
        help =
            fmt::format("a number does not hold where a variable is: declare a {}", describe(from));
    if (from.element && same_type(*from.element, to))
        help = "write '^' behind it: what it refers to";
    if (to.is_reference() && from.is_reference()) help = "both are to refer to one type";
    if (to.is_reference() && !from.is_reference())
        help = to.is_alias() ? "a REFERENCE TO is given a variable of its type"
                             : "write ADR(...) or REF(...) of a variable";
    return c.fail(code::type_does_not_fit, e.place,
                  fmt::format("expected {}, found {}", describe(to), describe(from)),
                  std::move(help));
}

/// A REFERENCE TO is given a variable, or another reference; of B&R a number that is an address.
bool bind(Checking& c, Expression*& e, const Type& to) {
    if (is_null(*e)) return become(c, e, to, {});
    const Dialect& dialect = e->place.dialect();
    const bool is_address = dialect.references_take_addresses && holds_address(*e->type) &&
                            to.element &&
                            (dialect.references_take_numbers || !same_type(*to.element, *e->type));
    if (is_address) return convert_address(c, e, to);
    if (to.element && to.element->kind == Kind::handle) take_place_of_object(c, e);
    const Type& from = *e->type;
    const bool sees_bytes = from.is_pointer() && from.element && to.element &&
                            is_of_bytes(*from.element) && packed_bits(*to.element, iec) > 0;
    if (from.is_reference() && from.element && (is_target(to, *from.element) || sees_bytes))
        return become_converted(c, e, to);
    if (!to.element) return false;
    const bool are_texts = e->place.dialect().texts_have_any_length && from.kind == Kind::text &&
                           to.element->kind == Kind::text;
    const bool are_arrays = dialect.references_take_numbers && from.kind == Kind::array &&
                            to.element->kind == Kind::array &&
                            same_type(*from.element, *to.element->element);
    const bool are_pointers =
        e->place.dialect().is_loose && from.is_pointer() && to.element->is_pointer();
    if (!are_texts && !are_arrays && !are_pointers && !is_target(to, from))
        return refuse_target(c, *e, to, from);
    return refer(c, e, to);
}

bool is_of_block(const Type& type) {
    return type.kind == Kind::block || type.kind == Kind::interface;
}

bool refers_to_block(const Type& type) {
    return type.is_reference() && type.element && is_of_block(*type.element);
}

/// `given` as one of `to`, or none if it is not.
Expression* attempted(Checking& c, Expression* given, const Type& to) {
    if (given->type->kind == Kind::block) note_lending(c, *given);
    if (to.kind == Kind::interface) note_held_instance(c, *given);
    if (Variable* root = root_of(*given).variable) root->used = true;
    Expression* made = make_converted(c, given, to);
    made->conversion.is_attempt = c.checked.dispatches = true;
    return made;
}

/// What another block is made of is to be known before what refers to it.
void depend_on_target(Checking& c, const Type* target, Place place) {
    const Routine* own = c.routine && c.routine->owner ? c.routine->owner : c.routine;
    if (!target || (target->kind == Kind::block && target->routine == own)) return;
    depend(c, target, place, true);
}

const Type* check_moved(Checking& c, Expression*& e) {
    Expression *&pointer = e->operands[0], *&by = e->operands[1];
    if (e->op == Word::plus && !pointer->type->is_reference()) std::swap(pointer, by);
    const bool is_number = by->type->is_integer() || by->type->is_bits();
    if (!pointer->type->is_pointer() || !is_number)
        return refuse_operands(c, *e,
                               "to a POINTER a whole number of bytes is added: p + SIZEOF(p^)");
    become_lint(c, by);
    return e->type = pointer->type;
}

/// `p + index * SIZEOF(p^)`
Expression* moved_by_index(Checking& c, const Expression& e) {
    Expression *pointer = e.operands[0], *index = e.arguments[0].value;
    Expression* size =
        make_constant(c, *index, lint_type, {.integer = Wide{bytes_of(*pointer->type->element)}});
    Expression* bytes = make_binary(c, index->place, index->place, Word::times, index, size);
    bytes->type = &lint_type;
    Expression* moved = make_binary(c, e.place, e.place, Word::plus, pointer, bytes);
    moved->type = pointer->type;
    return moved;
}

}  // namespace

bool holds_address(const Type& type) {
    const bool is_number = type.kind == Kind::integer || type.kind == Kind::bits;
    return is_number && type.bits >= 32 && !type.is_subrange;
}

bool refer(Checking& c, Expression*& e, const Type& to) {
    if (e->kind == E::deref && e->operands[0]->type->element == e->type &&
        (e->operands[0]->kind == E::name || e->operands[0]->kind == E::member)) {
        e = e->operands[0];
        return become_converted(c, e, to);
    }
    if (to.is_pointer()) keep_constant(c, e);
    if (const std::string_view why = why_no_place(*e, to.is_pointer()); !why.empty())
        return c.fail(code::type_does_not_fit, e->place, std::string(why),
                      "declare a variable, and refer to that");
    note_lending(c, *e);
    const Expression& root = root_of(*e);
    if (root.variable) {
        root.variable->used = true;
        if (root.variable->space == Space::image)
            c.checked.is_referred[c.checked.image.part_of(root.variable->address)] = true;
        c.checked.refers_to_in_outs |= root.variable->space == Space::reference;
    }
    e = make_reference_to(c, e, to);
    return true;
}

bool become_base(Checking& c, Expression*& e, const Type& base) {
    if (!is_place(*e)) return false;
    Expression* place = e;
    if (!refer(c, place, make_reference(c, Referring::pointer, e->type))) return false;
    become_converted(c, place, make_reference(c, Referring::pointer, &base));
    e = make_target(c, *e, place, &base);
    return true;
}

const Type& pointer_to(Checking& c, const Type& target) {
    return make_reference(c, Referring::pointer, &target);
}

const Type* resolve_reference(Checking& c, const TypeText& text) {
    const Referring referring = text.name.word == Word::ref_to_    ? Referring::ref
                                : text.name.word == Word::pointer_ ? Referring::pointer
                                                                   : Referring::alias;
    Type& type = make_reference(c, referring, nullptr);
    const Place& place = text.name.place;
    if (place.source) type.pointer_bytes = place.dialect().pointer_bytes;
    c.checked.has_references = true;
    if (c.knows_types)
        type.element = resolve(c, *text.element);
    else
        c.targets.emplace_back(&type, text.element);
    return &type;
}

void resolve_targets(Checking& c) {
    c.knows_types = true;
    for (const auto& [type, target] : c.targets) type->element = resolve(c, *target);
    c.targets.clear();
}

const Type* check_target_of(Checking& c, Expression*& e) {
    const Type* type = check(c, e->operands[0]);
    if (!type) return nullptr;
    if (type->is_open_array()) {
        e = e->operands[0];
        return type;
    }
    if (!type->is_reference())
        return c.fail(code::type_does_not_fit, e->place,
                      fmt::format("'^' does not go with {}", describe(*type)),
                      "it takes what a REF_TO or a POINTER TO refers to");
    depend_on_target(c, type->element, e->place);
    return type->element;
}

const Type* take_target(Checking& c, Expression*& e) {
    const Type* target = e->type->element;
    depend_on_target(c, target, e->place);
    e = make_target(c, *e, e, target);
    return target && target->is_alias() ? take_target(c, e) : target;
}

const Type* check_pointer_index(Checking& c, Expression*& e) {
    Expression* pointer = e->operands[0];
    const Type* target = pointer->type->element;
    std::vector<Argument> indices = e->arguments;
    for (Argument& argument : indices) {
        Expression*& index = argument.value;
        if (!target || !index->type) return nullptr;
        enumeration_becomes_number(c, index);
        if (indices.size() != pointer->type->dimensions ||
            !(index->type->is_integer() || index->type->is_bits()))
            return c.fail(code::type_does_not_fit, index->place,
                          pointer->type->is_open
                              ? fmt::format("{} has {} whole numbers as index",
                                            describe(*pointer->type), pointer->type->dimensions)
                              : "a POINTER has one index, a whole number");
        become_lint(c, index);
    }
    e = make_with(c, *e, std::move(indices));
    Expression* moved = pointer->type->is_open ? moved_in_open_array(c, *e) : moved_by_index(c, *e);
    depend_on_target(c, target, e->place);
    e = make_target(c, *e, moved, target);
    return target;
}

void note_lending(Checking& c, const Expression& place) {
    const Expression& root = root_of(place);
    if (c.routine && root.variable && root.variable->ends_with_call()) c.routine->lends = true;
}

void note_held_instance(Checking& c, const Expression& given) {
    const Variable* root = given.type->kind == Kind::block ? root_of(given).variable : nullptr;
    if (c.routine && root && root->ends_with_call()) c.routine->holds_instance = true;
}

void check_attempt(Checking& c, Statement& s) {
    const Type* type = check(c, s.target);
    if (!check(c, s.value, type) || !type) return;
    Expression *&target = without_alias(s.target), *&given = without_alias(s.value);
    const Type &to = *target->type, &from = *given->type;
    const bool fits = (to.kind == Kind::interface || refers_to_block(to)) &&
                      (is_of_block(from) || refers_to_block(from) || is_null(*given));
    const bool are_alike = to.is_reference() && same_type(to, from);  // nothing to find out
    if (!fits && !are_alike)
        return (void)c.fail(
            code::type_does_not_fit, s.place,
            fmt::format("'?=' does not go with {} and {}", describe(to), describe(from)),
            "it gives a variable of an interface, or a reference to a block, what is of its type");
    s.op = Word::assign;
    s.target = target;
    if (!check_target(c, *target) || !fits || is_null(*given)) return (void)coerce(c, given, to);
    s.value = attempted(c, given, to);
}

bool take_query(Checking& c, Expression*& e, const Routine& called) {
    const Token& name = called.pou->name;
    const bool wants_pointer = same_name(name.text, "__querypointer");
    const bool is_query = wants_pointer || same_name(name.text, "__queryinterface");
    if (!is_library(name) || !is_query || e->arguments.size() != 2) return true;
    Expression *from = e->arguments[0].value, *to = e->arguments[1].value;
    if (!check(c, from) || !check(c, to)) return false;
    Expression* given = without_alias(from);
    const bool fits = is_of_block(*given->type) || refers_to_block(*given->type);
    const bool is_wanted =
        wants_pointer ? refers_to_block(*to->type) : to->type->kind == Kind::interface;
    if (!fits || !is_wanted) return true;
    const Type& any = *called.variables.back().type;
    to = make_copy(c, *to);
    given = make_converted(c, attempted(c, given, *to->type), any);
    to->type = &any;
    e = make_with(c, *e, {{.value = given}, {.value = to}});
    return true;
}

bool means_address(const Expression& e, const Expression& other) {
    const bool is_alias = e.kind == E::deref && e.operands[0]->type->is_alias();
    if (!is_alias || !e.type || !e.place.dialect().references_take_addresses) return false;
    const bool is_number = e.type->is_number() || e.type->is_bits();
    const bool is_kept_number = e.place.dialect().references_take_numbers &&
                                e.operands[0]->kind == E::member && holds_address(*other.type);
    return other.type->is_pointer() || ((is_null(other) || is_kept_number) && !is_number);
}

void take_addresses(Checking& c, Expression& e) {
    const bool is_order = e.op != Word::equal && e.op != Word::unequal;
    if (is_order && !e.place.dialect().references_take_numbers) return;
    for (std::size_t at = 0; at < 2; ++at) {
        Expression*& side = e.operands[at];
        if (means_address(*side, *e.operands[1 - at]))
            side = make_converted(c, side->operands[0], pointer_to(c, *side->type));
    }
}

void assign_address(Checking& c, Statement& s) {
    s.target = without_alias(s.target);
    bind(c, s.value, *s.target->type);
}

void check_reference_assignment(Checking& c, Statement& s) {
    const Type* type = check(c, s.target);
    const Type* given = check(c, s.value);
    if (!type) return;
    Expression*& target = without_alias(s.target);
    if (!target->type->is_reference())
        return void(c.fail(code::type_does_not_fit, s.target->place,
                           fmt::format("REF= does not go with {}", describe(*type)),
                           "it gives a REFERENCE TO the variable that it refers to"));
    if (!given || !check_target(c, *target)) return;
    s.target = target;
    bind(c, s.value, *target->type);
}

const Type* check_reference_operator(Checking& c, Expression*& e, const Type* expected) {
    Expression *&left = e->operands[0], *&right = e->operands[1];
    const bool is_sum = e->op == Word::plus || e->op == Word::minus;
    const bool both = left->type->is_reference() && right->type->is_reference();
    if (e->op == Word::minus && right->type->is_pointer() && left->type->is_integer() &&
        holds_address(*left->type))
        return coerce(c, right, *left->type) ? e->type = left->type : nullptr;
    if (is_sum && !both) return check_moved(c, e);
    const Type& type =
        left->type->is_reference() && left->type != &null_type ? *left->type : *right->type;
    if (e->op == Word::minus && type.is_pointer() && coerce(c, left, type) &&
        coerce(c, right, type)) {
        const bool fits = expected && expected->is_integer() && expected->bits >= 32;
        return e->type = fits ? expected : &dint_type;
    }
    Expression*& number = left->type->is_reference() ? right : left;
    if (is_comparison(e->op) && type.is_pointer() && holds_address(*number->type)) {
        Expression*& pointer = left->type->is_reference() ? left : right;
        return coerce(c, pointer, *number->type) ? e->type = &bool_type : nullptr;
    }
    const bool order = e->op != Word::equal && e->op != Word::unequal;
    if (!is_comparison(e->op) || (order && !type.is_pointer()))
        return c.fail(code::type_does_not_fit, e->token.place,
                      fmt::format("'{}' does not go with {}", shown(e->op), describe(type)),
                      type.is_pointer() ? "a POINTER takes '+' and '-' with bytes, and is compared"
                                        : "references are equal or not");
    return coerce(c, left, type) && coerce(c, right, type) ? e->type = &bool_type : nullptr;
}

/// THIS where a pointer to something else, or a number for an address, is wanted.
static bool points_at_own_instance(const Expression& e, const Type& to) {
    const bool is_pointer = to.is_pointer() && to.element && !is_target(to, *e.type);
    return e.kind == E::self && e.place.dialect().is_loose && (is_pointer || holds_address(to));
}

bool coerce_reference(Checking& c, Expression*& e, const Type& to) {
    if (points_at_own_instance(*e, to) && !refer(c, e, pointer_to(c, *e->type))) return false;
    const Type& from = *e->type;
    if (from.is_pointer() && &from != &null_type && holds_address(to))
        return convert_address(c, e, to);
    if (to.is_pointer() && holds_address(from)) return convert_address(c, e, to);
    if (to.kind == Kind::interface && &from == &null_type) return become(c, e, to, {});
    if (!to.is_reference()) return refuse_target(c, *e, to, from);
    const bool is_this = to.is_pointer() && e->kind == E::self;
    if (to.is_alias() || is_this) return bind(c, e, to);
    if (is_null(*e)) return become(c, e, to, {});
    if (&from == &to || same_type(from, to)) return true;
    const bool are_pointers = to.is_pointer() && from.is_pointer() && to.element && from.element;
    const bool fits =
        from.is_reference() && from.element &&
        (is_target(to, *from.element) ||
         (are_pointers && (e->place.dialect().is_loose || begins_with(*from.element, *to.element) ||
                           (is_of_bytes(*from.element) && packed_bits(*to.element, iec) > 0))));
    if (fits) return become_converted(c, e, to);
    if (!to.element || (from.is_reference() && !from.element)) return false;
    return refuse_target(c, *e, to, from);
}

const Type* use_kept_pointer(Checking& c, Expression*& e, const Variable& member) {
    e->type = member.type;
    return coerce(c, e, *member.pointer) ? e->type : nullptr;
}

Expression* keeper_of_pointer(Expression* e) {
    Expression* kept = e->kind == E::converted ? e->operands[0] : nullptr;
    return kept && kept->variable && kept->variable->pointer ? kept : e;
}

}  // namespace lineshaft::st

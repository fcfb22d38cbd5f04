#include "runtime/source/letters.hpp"
#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/implicit_checks.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/parameters.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

Variable* find_member(const Type& type, std::string_view name) {
    if (type.kind == Kind::block) return find_in(type.routine->names, name);
    Variable* const* member = find_called(type.members, name, &Variable::text);
    return member ? *member : nullptr;
}

std::vector<std::string> names_of(const std::vector<Variable*>& variables) {
    std::vector<std::string> names;
    for (const Variable* variable : variables) names.emplace_back(variable->text);
    return names;
}

std::vector<std::string> shown_names(const std::vector<Variable*>& parts, Place place) {
    if (!place.dialect().pins_have_long_names) return names_of(parts);
    std::vector<std::string> names;
    for (const Variable* part : parts) names.push_back(long_part_name(part->text));
    return names;
}

namespace {

/// The block, or that of its bases, which the variable stands in.
const Routine* declaring_block(const Routine& block, const Variable& variable) {
    const Routine* found = &block;
    while (found->base && found->pou != variable.of) found = found->base;
    return found;
}

bool is_of_library(const Type& type) {
    return type.kind == Kind::block && is_library(type.routine->pou->name);
}

/// Its members; of a timer and its like, and of a library's block, the pins alone, which are all
/// that the standard or the library's manual has.
std::vector<Variable*> told_members(const Type& type) {
    std::vector<Variable*> members =
        type.kind == Kind::block ? all_variables(*type.routine) : type.members;
    if ((type.kind == Kind::standard && !type.is_object()) || is_of_library(type))
        std::erase_if(members, [](const Variable* m) { return m->section == Section::local; });
    return members;
}

/// `type` has no member `name`: nothing, and what is there instead is said.
const Type* fail_member(Checking& c, const Expression& e, const Type& type, std::string_view name) {
    std::vector<std::string> names = type.kind == Kind::standard
                                         ? shown_names(told_members(type), e.place)
                                         : names_of(told_members(type));
    if (lacks_base(type)) return nullptr;
    if (type.kind == Kind::interface)
        for (const auto known : {&Routine::methods, &Routine::getters})
            for (const auto& [method, routine] : type.routine->*known) names.emplace_back(method);
    if (is_of_library(type))
        for (const auto& [method, routine] : type.routine->methods)
            if (routine->pou->access != Access::private_) names.emplace_back(method);
    if (names.empty())
        return c.fail(code::type_does_not_fit, e.token.place,
                      fmt::format("{} has no parts", describe(type)),
                      "'.' takes a part of a structure or of an instance");
    if (type.is_object())
        for (const auto& [routine, part] : c.prelude.routines)
            if (routine.starts_with(std::string(type.standard->handle) + '.'))
                names.emplace_back(routine.substr(type.standard->handle.size() + 1));
    std::ranges::sort(names);
    return c.fail(code::not_declared, e.token.place,
                  fmt::format("{} has no '{}'", describe(type), name), suggest(name, names));
}

/// CODESYS, B&R: `status.READY`, the bit of a constant's number, of B&R also of an enumeration's.
/// Null: it is none, and nothing told.
const Type* check_named_bit(Checking& c, Expression*& e, const Type& type) {
    const bool has_bits = type.kind == Kind::bits || type.kind == Kind::integer;
    const Dialect& dialect = e->place.dialect();
    if (!has_bits || !dialect.takes_what_others_refuse || e->operands[0]->kind == E::bit)
        return nullptr;
    const Variable* number = find_variable(c, e->token);
    const bool is_number = number && number->space == Space::constant && number->type &&
                           (number->type->is_integer() || number->type->is_bits());
    const NamedValue* value =
        number || dialect.is_loose ? nullptr : c.look_up(&Names::values, e->token);
    if (!is_number && !value) return nullptr;
    const Wide bit = is_number ? number->value.integer : Wide{value->type->numbers[value->index]};
    if (bit < 0 || bit >= type.bits) return nullptr;
    if (is_number) c.note(e->token.place, *number);
    e = make_bit(c, *e, e->operands[0]);
    e->bits = {static_cast<std::uint8_t>(bit), 1};
    return &bool_type;
}

/// What there is once, however it is named: by THIS, by an instance, by a PROGRAM.
const Type* use_only_one(Checking& c, Expression*& e) {
    Expression* only = make_use(c, *e, *e->variable);
    only->operands[0] = e->operands[0];  // that it is written from outside can be told
    e = only;
    return e->type;
}

/// The AXIS_REF itself, which became the axis for one of its fields.
Expression* without_conversion(Expression* axis) {
    const bool is_made =
        axis->kind == E::converted && axis->operands[0]->type->kind == Kind::handle;
    return is_made ? axis->operands[0] : axis;
}

/// `axis.Modulo.Enable` of Siemens, whose `Modulo` alone is a field of the axis. Null: it is none.
Routine* part_behind_field(Checking& c, const Expression& e) {
    const Expression& of = *e.operands[0];
    if (of.kind != E::member || !of.operands[0]->type) return nullptr;
    return find_part(c, *of.operands[0]->type, fmt::format("{}.{}", of.token.text, e.token.text));
}

}  // namespace

/// ENO of an instance that has no such output: without an EN it was executed.
static const Type* check_enabled(Checking& c, Expression*& e) {
    Variable* flag = enable_flag(c, *e->operands[0]);
    if (!flag) return become(c, e, bool_type, {.integer = 1});
    e = make_use(c, *e, *flag);
    return use(c, e, *flag);
}

const Type* check_member(Checking& c, Expression*& e) {
    name_block_of_list(c, *e);
    if (const auto name = qualified_name(c, *e)) {
        e = make_name(c, *e, name->text);
        return check(c, e);
    }
    if (const Type* enumeration = enumeration_of(c, *e))
        return check_value(c, e, *enumeration, e->token);
    if (is_object_of(c, *e))
        use_object(c, e->operands[0], *object_type(c, *standard_type(c, technology_object)));
    if (refuse_member_of_namespace(c, *e) || refuse_of_list(c, *e)) return nullptr;
    const Type* type = check(c, e->operands[0]);
    if (!type) return nullptr;
    if (Routine* part = find_part(c, *type, e->token.text)) return check_part(c, e, *part);
    if (Routine* part = part_behind_field(c, *e)) {
        e->operands[0] = without_conversion(e->operands[0]->operands[0]);
        return check_part(c, e, *part);
    }
    if (Routine* getter = find_accessor(c, *e, Accessor::get)) return check_getter(c, e, *getter);
    if (type->kind == Kind::handle) {
        type = object_type(c, *type);
        convert(c, e->operands[0], *type);
    }
    const std::string_view name = standard_name(*type, e->token.text);
    if (Variable* found = find_member(*type, name)) {
        c.note(e->token.place, *found);
        const bool is_value = found->space == Space::constant;
        const bool is_own = type->kind == Kind::block && e->operands[0]->kind == E::self;
        const bool is_seen = is_own || c.is_in_test() || found->access == Access::public_;
        if (is_value && (is_seen || e->place.dialect().is_loose)) {
            found->used = true;
            return become(c, e, *found->type, found->value);
        }
        if (type->kind == Kind::block && !is_own && (found->section == Section::temp || is_value))
            return c.fail(code::not_declared, e->token.place,
                          fmt::format("'{}' of {} is not seen from outside", name, type->name),
                          "make it a VAR_OUTPUT");
        if (type->kind == Kind::block && found->of &&
            !is_accessible(c, found->access, *declaring_block(*type->routine, *found), e->token))
            return nullptr;
        found->used = true;
        e->variable = found;
        if (found->space == Space::overlay) return use_overlay(c, e, *found);
        if (found->pointer) return use_kept_pointer(c, e, *found);
        if (found->space == Space::global && type->kind == Kind::block) return use_only_one(c, e);
        return found->type;
    }
    if (type->kind == Kind::array && same_name(name, "this")) {  // "Recipes".THIS[1]
        e = e->operands[0];
        return type;
    }
    if (type->is_instance() && same_name(name, "eno")) return check_enabled(c, e);
    if (const Type* bit = check_named_bit(c, e, *type)) return bit;
    if (const auto address = check_data_address(c, e)) return *address;
    return fail_member(c, *e, *type, name);
}

const Type* check_index(Checking& c, Expression*& node) {
    Expression& e = *node;
    const Type* type = check(c, e.operands[0]);
    for (Argument& argument : e.arguments) {
        const bool is_power =
            argument.value->kind == E::binary && argument.value->op == Word::power;
        check(c, argument.value, is_power ? &lint_type : nullptr);
    }
    for (Argument& argument : e.arguments) {
        if (!type) return nullptr;
        if (type->is_pointer()) return check_pointer_index(c, node);
        const bool of_text = type->kind == Kind::text;
        if (type->kind != Kind::array && !of_text)
            return c.fail(code::type_does_not_fit, argument.value->place,
                          fmt::format("{} has no elements", describe(*type)),
                          e.arguments.size() > 1 ? "there are more indices than dimensions" : "");
        if (!argument.value->type) return nullptr;
        enumeration_becomes_number(c, argument.value);
        const Type* given = argument.value->type;
        if (!given->is_integer() && !given->is_bits())
            return c.fail(code::type_does_not_fit, argument.value->place,
                          fmt::format("an index is a whole number, not {}", describe(*given)));
        const Wide value = argument.value->constant.integer;
        if (is_constant(*argument.value)) {
            const Wide lower = of_text ? (e.place.dialect().texts_are_bytes ? 0 : 1) : type->lower,
                       upper = of_text ? type->length : type->upper;
            if (value < lower || (value > upper && !type->is_open))
                return c.fail(code::value_out_of_range, argument.value->place,
                              fmt::format("there is no element {}", to_string(value)),
                              fmt::format("the index goes from {} to {}", to_string(lower),
                                          to_string(upper)));
            take_type(c, argument.value, lint_type, {.integer = value});
        } else if (!of_text) {
            guard_index(c, argument.value, *type);
        }
        if (of_text)
            type = e.place.dialect().texts_are_bytes ? &bits_type(type->is_wide ? 16 : 8)
                   : type->is_wide                   ? &wide_char_type
                                                     : &char_type;
        else
            type = type->element;
    }
    return type;
}

const Type* check_bit(Checking& c, Expression*& e) {
    struct Part {
        char letter;
        int bits;
        std::string_view names;
    };
    static constexpr Part parts[] = {
        {'X', 1, "bits"}, {'B', 8, "bytes"}, {'W', 16, "words"}, {'D', 32, "double words"}};
    if (!check(c, e->operands[0])) return nullptr;
    if (const auto address = check_data_address(c, e)) return *address;
    if (e->place.dialect().enumerations_are_numbers) enumeration_becomes_number(c, e->operands[0]);
    const Type* type = e->operands[0]->type;
    std::string_view text = e->token.text;
    const Part* known = parts;
    if (e->token.word == Word::direct) {
        const char letter = text.size() > 1 ? text[1] : '\0';
        if (!is_digit(letter)) known = std::ranges::find(parts, upper(letter), &Part::letter);
        text.remove_prefix(std::min<std::size_t>(is_digit(letter) ? 1 : 2, text.size()));
    }
    const auto number = read_integer(text);
    if (!number || known == std::end(parts))
        return c.fail(code::something_else_expected, e->token.place,
                      fmt::format("'{}' is not a bit", e->token.text),
                      "write .%X0 for a bit, .%B0 for a byte, .%W0 for a word");
    const auto& [letter, bits, names] = *known;
    if (type->kind != Kind::bits && type->kind != Kind::integer)
        return c.fail(code::type_does_not_fit, e->token.place,
                      fmt::format("{} has no bits", describe(*type)),
                      "bits are those of BYTE to LWORD and of integers");
    if ((*number + 1) * bits > type->bits)
        return c.fail(code::value_out_of_range, e->token.place,
                      fmt::format("{} has no part '{}'", describe(*type), e->token.text),
                      fmt::format("its {} are 0 to {}", names, type->bits / bits - 1));
    const Expression& whole = *e->operands[0];
    const bool of_part = whole.kind == E::bit;
    const Wide first = *number * bits + (of_part ? whole.bits.first : 0);
    if (of_part) e = make_bit(c, *e, whole.operands[0]);
    e->bits = {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(bits)};
    return bits == 1 ? &bool_type : &bits_type(bits);
}

/// `axis.Override.Velocity`, which a FUNCTION of the axis gives.
static bool is_tag_of_axis(const Expression& target) {
    const Expression* of = &target;
    while (of->kind == E::member && of->operands[0]) of = of->operands[0];
    return of->kind == E::call && of->routine && of->routine->name.starts_with("AXIS_REF.");
}

static bool inherits(const Routine* block, const Variable& variable) {
    while (block && block->pou != variable.of) block = block->base;
    return block;
}

bool check_target(Checking& c, Expression& target, std::string_view how) {
    const auto refuse = [&](std::string what, std::string help) {
        return c.fail(code::cannot_be_assigned, target.place,
                      fmt::format("{} cannot be {}", what, how), std::move(help));
    };
    if (target.kind == E::constant && target.variable)
        return refuse(fmt::format("the constant '{}'", target.variable->text),
                      "declare it in VAR, without CONSTANT");
    if (target.kind == E::bit && target.operands[0]->is_character())
        return refuse("a bit of a character", "assign the character");
    if (target.kind == E::index || target.kind == E::bit) {
        return !target.operands[0]->type || check_target(c, *target.operands[0], how);
    }
    if (target.kind == E::self || target.kind == E::deref) return true;
    if (is_tag_of_axis(target))
        return refuse("a tag of an axis",
                      "it is read only here: give the axis its value in YAML (default_velocity: 80 "
                      "mm/s), or call PLCopen.MC_SetOverride or PLCopen.MC_WriteParameter, which "
                      "lineshaft has beside the controller's blocks");
    if (target.kind != E::name && target.kind != E::member)
        return refuse("a value", "a variable, an element or a member stands left of ':='");
    Variable* variable = target.variable;
    if (!variable) return false;
    if (variable->space == Space::image) variable->is_set = true;
    const bool own = !target.operands[0] || target.operands[0]->kind == E::self;
    const bool of_instance =
        !own && target.operands[0]->type && target.operands[0]->type->is_instance();
    const bool is_own_copy = variable->section == Section::input && target.place.dialect().is_loose;
    if (variable->constant && !is_own_copy && !(c.is_in_test() && of_instance))
        return refuse(fmt::format("the constant '{}'", variable->text), "remove CONSTANT");
    const bool is_copy = variable->of && (variable->of->kind == PouKind::function ||
                                          variable->of->kind == PouKind::method);
    if (own && variable->section == Section::input && !is_copy && variable->of &&
        c.assigned_inputs.insert(variable->of).second)
        c.warn(code::input_assigned, target.place,
               fmt::format("the input '{}' is {} in its own block", variable->text, how),
               "it keeps that until a caller gives it again: copy it to a variable of VAR");
    if (own) return true;
    const Type* of = target.operands[0]->type;
    const bool is_named = target.operands[0]->variable || target.operands[0]->kind == E::converted;
    const bool is_block = of && (of->kind == Kind::block || is_prelude(target.token));
    const bool is_own_there =
        target.place.dialect().sets_variables_of_instances &&
        (variable->section == Section::output ||
         (is_block && (variable->section == Section::local || is_kept_in_out(*variable))));
    const bool is_local = variable->section == Section::local;
    const bool is_public = is_local && (variable->access == Access::public_ ||  // 6.6.5.10
                                        (is_library(target.token) && of && !is_block));
    const bool is_inherited =
        is_local && target.place.dialect().is_loose && inherits(own_block(c), *variable);
    if (of && of->is_instance() && variable->section != Section::input && !c.is_in_test() &&
        is_named && !is_own_there && !is_public && !is_inherited)
        return refuse(
            fmt::format("'{}' of {}",
                        variable->space == Space::global ? target.token.text : variable->text,
                        of->name),
            "only inputs of an instance are set from outside");
    return of && of->is_instance() ? true : check_target(c, *target.operands[0], how);
}

}  // namespace lineshaft::st

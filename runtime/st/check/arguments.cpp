#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/check/variants.hpp"
#include "runtime/st/types/parameters.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

bool is_variable(const Expression& e) {
    return e.kind == E::name || e.kind == E::member || e.kind == E::self || e.kind == E::deref ||
           (e.kind == E::index && !e.is_character());
}

/// A structure or an array that came as an input, or in one, is passed on by reference.
bool is_own_input(const Expression& e) {
    const Expression* root = &e;
    while (root->kind != E::name && root->operands[0]) root = root->operands[0];
    return root->variable && root->variable->section == Section::input &&
           (!e.type->is_scalar() || e.type->is_handle());
}

/// CODESYS lends what a program has, and outputs of a block.
bool is_lent(const Expression& e) {
    const Expression* root = &e;
    while (root->kind == E::index || root->kind == E::bit) root = root->operands[0];
    if (root->kind != E::member || !root->operands[0]->type) return false;
    const Type& of = *root->operands[0]->type;
    return e.place.dialect().is_loose && of.kind == Kind::block && of.routine &&
           (of.routine->pou->kind == PouKind::program ||
            (root->variable && root->variable->section == Section::output));
}

/// What a slot has of a variable of CODESYS' is what it has of that number: a subrange's value, and
/// an enumeration's, of one that is strict where its values are counted from 0 on.
bool is_kept_as(const Type& given, const Type& number) {
    const bool counts = given.kind == Kind::enumeration && given.has_numbers && given.counted;
    return (given.is_unchecked || counts) && same_type(given.base->plain(), number);
}

/// An instance of another block that extends that of the parameter.
bool is_derived(const Type& given, const Type& type) {
    return given.kind == Kind::block && type.kind == Kind::block &&
           is_a(*given.routine, *type.routine);
}

/// What to do about a variable of another type.
std::string help_of_given(const Expression& value, const Type& type, bool texts) {
    if (texts) return "a VAR_IN_OUT of type STRING, without a length, takes any";
    const bool hides =
        type.kind == Kind::handle && value.kind == E::name && value.variable && value.variable->of;
    if (!hides) return "";
    return fmt::format(
        "the variable '{}' hides a block of the program that has its name: give it another one",
        value.variable->text);
}

/// CODESYS and Siemens convert an output as they convert what is assigned.
bool takes_outputs_as_assigned(const Dialect& dialect) {
    return dialect.is_loose || dialect.packs_as_s7;
}

/// A variable of type `given` stands for an output or a VAR_IN_OUT.
void check_given(Checking& c, const Argument& argument, const Variable& parameter,
                 const Type& given) {
    Expression* const value = argument.value;
    const Type* type = parameter.type;
    if (argument.is_negated && (type->kind != Kind::boolean || given.kind != Kind::boolean))
        return void(c.fail(code::type_does_not_fit, argument.name.place,
                           fmt::format("NOT takes a BOOL to a BOOL, not {} to {}", describe(*type),
                                       describe(given)),
                           "take the output as it is"));
    const bool texts = given.kind == Kind::text && type->kind == Kind::text;
    const Dialect& dialect = value->place.dialect();
    const bool are_arrays = given.kind == Kind::array && type->kind == Kind::array;
    const bool has_other_bounds = are_arrays && given.count() == type->count() && given.element &&
                                  type->element && same_type(*given.element, *type->element) &&
                                  dialect.takes_what_others_refuse && !dialect.is_loose;
    const bool derives = parameter.section == Section::in_out && is_derived(given, *type);
    const bool is_split = parameter.of && parameter.of->place.source->is_prelude() &&
                          type->is_integer() && given.is_integer();  // of a date: any integer
    const bool is_number =
        value->place.dialect().enumerations_are_numbers && is_kept_as(given, *type);
    const auto becomes = [&] {
        Expression output = *value;
        output.kind = E::name;
        output.type = type;
        return takes_outputs_as_assigned(dialect) && may_become(c, output, given);
    };
    const bool are_pointers = dialect.is_loose && given.is_pointer() && type->is_pointer();
    const bool is_of_own = parameter.section == Section::output && type->is_alias() &&
                           type->element && same_type(given, *type->element);
    const bool fits =
        same_type(given, *type) || derives || is_number || are_pointers || is_of_own ||
        ((parameter.section == Section::output || type->kind == Kind::structure) &&
         has_same_form(c, value->place, *type, given)) ||
        (parameter.section == Section::in_out
             ? has_other_bounds || (texts && type->is_open)
             : texts || is_split ||
                   (type->is_scalar() &&
                    (widens(*type, given) || are_same_pattern(*type, given) || becomes())));
    note_lending(c, *value);
    if (!fits)
        c.fail(code::type_does_not_fit, value->place,
               fmt::format("'{}' is {}, and {} is given", parameter.text, describe(*type),
                           describe(given)),
               help_of_given(*value, *type, texts));
}

/// It is a part of packed bytes, of a UNION, of the image, or of a standard block.
bool is_in_bytes(const Expression& e) {
    for (const Expression* at = &e; is_variable(*at); at = at->operands[0]) {
        if (at->variable && at->variable->space == Space::image) return true;
        if (at->kind != E::member && at->kind != E::index) return false;
        const Type* of = at->operands[0]->type;
        if (!of || of->kind == Kind::union_ || of->kind == Kind::standard) return true;
    }
    return false;
}

/// It may be given as a value.
bool takes_copies(const Type& type) {
    return (type.is_scalar() || type.kind == Kind::text) && !type.is_handle();
}

const Type& text_of(Checking& c, bool is_wide, std::size_t length) {
    Type& made = c.make_type(Kind::text, is_wide ? "WSTRING" : "STRING");
    made.length = static_cast<std::uint32_t>(length);
    made.is_wide = is_wide;
    return made;
}

/// What `value` is made as a VAR_IN_OUT CONSTANT of the type.
const Type& lent_as(Checking& c, const Expression& value, const Type& type) {
    constexpr std::size_t longest = 255;  // that a standard function gives
    if (!type.is_open) return type;
    const bool is_alike = value.type->kind == Kind::text && value.type->is_wide == type.is_wide;
    const bool is_variable = is_alike && (value.kind != E::call || value.routine);
    return is_variable ? *value.type : text_of(c, type.is_wide, longest);
}

/// A variable that stays, with the constant.
Variable& keep_constant(Checking& c, Expression& constant, const Type& type) {
    const bool is_text = type.kind == Kind::text;
    Variable& kept =
        c.make_variable(constant.token, {},
                        is_text ? &text_of(c, type.is_wide, constant.constant.text.size()) : &type);
    kept.initial = &constant;
    kept.used = true;
    keep_once(c, kept);
    return kept;
}

/// A value that a VAR_IN_OUT CONSTANT is given stands in a variable, to which that refers: a
/// constant in one that stays, what is computed in one of the call.
void lend_value(Checking& c, Argument& argument, const Variable& parameter) {
    Expression*& value = argument.value;
    const Type& type = lent_as(c, *value, *parameter.type);
    if (!coerce(c, value, type)) return;
    if (is_constant(*value) && takes_copies(type)) {
        value = make_use(c, *value, keep_constant(c, *value, type));
        return;
    }
    depend(c, &type, value->place);
    if (!c.routine) {  // what a global variable begins with
        argument.made = &c.make_variable(value->token, {}, &type);
        argument.made->used = true;
        return keep_once(c, *argument.made);
    }
    const std::string& name = c.checked.names.emplace_back(fmt::format("%{}", parameter.text));
    argument.made = &c.make_variable(*c.routine, value->token, name, &type);
    argument.made->section = Section::temp;
    c.routine->lends = true;
}

}  // namespace

void check_argument(Checking& c, Argument& argument, Variable& parameter) {
    Expression*& value = argument.value;
    const Type* type = parameter.type;
    if (type && is_variant(*type)) argument.is_output = false;
    const bool is_set = c.is_in_test() && !argument.is_output && argument.is_named() &&
                        parameter.section != Section::in_out;
    const bool is_output = parameter.section == Section::output;
    const bool is_classic = value->place.dialect().outputs_may_be_assigned && is_output;
    if (is_classic && argument.is_named() && !is_set) argument.is_output = true;  // of STEP 7 V5
    const bool is_written_to = parameter.section == Section::in_out && is_prelude(parameter.name);
    const bool fits_sign =
        argument.is_output ? parameter.can_be_taken() || is_written_to : !is_output || is_set;
    if (argument.is_named() && !fits_sign) {
        check(c, value);
        c.fail(code::wrong_arguments, argument.name.place,
               fmt::format("'{}' is {} of the call", parameter.text,
                           is_output ? "an output" : "an input"),
               is_output ? "write '=>' and the variable that it goes to" : "write ':='");
        return;
    }
    if (parameter.section == Section::input || is_set) {
        if (type && is_variant(*type)) return become_variant(c, value, *type);
        if (type && is_any_input(*type)) return become_any(c, value, *type);
        const Type* given = check(c, value, type);
        if (!given || !type || refuse_copy_of_command(c, value->place, *type)) return;
        if (!is_derived(*given, *type)) coerce(c, value, *type);
        return;
    }
    const Type* given = check(c, value, type && type->kind == Kind::handle ? type : nullptr);
    if (!given || !type) return;
    if (type->kind == Kind::handle && given->is_object()) {
        if (parameter.space == Space::reference) {
            take_place_of_object(c, value);
            return check_given(c, argument, parameter, *value->type);
        }
        if (coerce(c, value, *type)) return;
    }
    const bool is_constant = parameter.section == Section::in_out && parameter.constant;
    const bool is_read = is_constant || (parameter.section == Section::in_out &&
                                         (is_own_input(*value) || is_lent(*value)));
    const bool is_taken = argument.is_output || is_output || is_copied_in_out(parameter);
    const bool is_place = is_variable(*value) || (is_taken && value->kind == E::bit);
    const auto has_its_form = [&] {
        return same_type(*given, *type) ||
               (value->place.dialect().enumerations_are_numbers && is_kept_as(*given, *type)) ||
               (type->is_open && given->kind == Kind::text && given->is_wide == type->is_wide);
    };
    const auto is_seen_whole = [&] { return has_its_form() && !is_in_bytes(*value); };
    if (is_constant && (!is_place || (takes_copies(*type) && !is_seen_whole())))
        return lend_value(c, argument, parameter);
    if (!is_place || (!is_read && !check_target(c, *value, "given here"))) {
        if (!is_place)
            c.fail(code::wrong_arguments, value->place,
                   fmt::format("'{}' takes a variable, not a value", parameter.text),
                   "declare one and give it here");
        return;
    }
    check_given(c, argument, parameter, *given);
}

}  // namespace lineshaft::st

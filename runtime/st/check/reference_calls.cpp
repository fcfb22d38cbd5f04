#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/classes.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/dynamic_memory.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

namespace {

/// A function's name stands for its result.
const Type* resolve_sized(Checking& c, const Token& name) {
    const Routine* function = c.find_routine(name);
    return function && !function->type && function->result ? function->result->type
                                                           : resolve_name(c, name);
}

const Type* check_size(Checking& c, Expression*& e) {
    if (e->of) {
        const Type* written = resolve(c, *e->of);
        if (!written) return nullptr;
        return become(c, e, any_integer_type, {.integer = Wide{bytes_of(*written)}});
    }
    Expression*& of = e->arguments[0].value;
    const auto qualified = qualified_name(c, *of);
    const Token name = qualified ? *qualified : of->token;
    const bool is_type =
        (qualified || of->kind == E::name) && !find_variable(c, name) && !is_own_instance(c, *of);
    const Type* type = is_type ? resolve_sized(c, name) : check(c, of);
    if (!type) return nullptr;
    return become(c, e, any_integer_type, {.integer = Wide{bytes_of(*type)}});
}

/// `ADR(text[i])` of bytes, a POINTER TO BYTE: so many behind the first one.
const Type* refer_to_byte(Checking& c, Expression*& e, Expression& byte) {
    Expression* first = byte.operands[0];
    Type& to_text = make_reference(c, Referring::pointer, first->type);
    if (!refer(c, first, to_text)) return nullptr;
    become_converted(c, first, make_reference(c, Referring::pointer, &bits_type(8)));
    e = make_binary(c, e->place, e->place, Word::plus, first, byte.arguments[0].value);
    return check(c, e);
}

const Type* check_refer(Checking& c, Expression*& e, Referring referring) {
    Expression* place = e->arguments[0].value;
    if (!check(c, place)) return nullptr;
    if (referring == Referring::pointer && place->is_character() &&
        place->place.dialect().texts_are_bytes)
        return refer_to_byte(c, e, *place);
    take_place_of_object(c, place);
    const Type* type = place->type;
    if (!refer(c, place, make_reference(c, referring, type))) return nullptr;
    e = place;
    return e->type;
}

const Type* check_is_bound(Checking& c, Expression*& e) {
    Expression*& given = e->arguments[0].value;
    if (!check(c, given)) return nullptr;
    const bool is_name = given->kind == E::name && given->variable;
    if (is_name && given->variable->section == Section::in_out && given->variable->constant)
        return become(c, e, bool_type, {.integer = 1});
    Expression* reference = without_alias(given);
    const bool is_own = given->kind == E::member && given->operands[0]->kind == E::self;
    const Variable* in_out = given->kind == E::name || is_own ? given->variable : nullptr;
    const auto refers = [&] {
        return reference->type->is_reference() || reference->type->kind == Kind::interface;
    };
    if (in_out && in_out->space == Space::reference && !refers()) {
        if (!refer(c, given, make_reference(c, Referring::ref, given->type))) return nullptr;
        reference = given;
    }
    if (!refers())
        return c.fail(
            code::type_does_not_fit, given->place,
            fmt::format("__ISVALIDREF takes a reference, not {}", describe(*given->type)));
    e = make_binary(c, e->place, e->token.place, Word::unequal, reference,
                    make_constant(c, *reference, *reference->type, {}));
    return e->type = &bool_type;
}

}  // namespace

std::optional<const Type*> check_reference_call(Checking& c, Expression*& e, const Type*) {
    const Token& name = e->operands[0]->token;
    const auto is = [&](std::string_view known) { return same_name(name.text, known); };
    if (is_of_dynamic_memory(name.text))
        return c.fail(
            code::wrong_place, name.place,
            fmt::format("{} stands in a statement of its own", name.text),
            is("__new") ? "assign it: pointer := __NEW(Type);" : "write '__DELETE(pointer);'");
    const bool is_known =
        is("adr") || is("ref") || is("sizeof") || is("xsizeof") || is("__isvalidref");
    if (!is_known) return {};
    if (!e->of && (e->arguments.size() != 1 || e->arguments[0].is_output))
        return c.fail(code::wrong_arguments, name.place,
                      fmt::format("{} takes 1 argument", name.text));
    if (is("sizeof") || is("xsizeof")) return check_size(c, e);
    if (is("__isvalidref")) return check_is_bound(c, e);
    return check_refer(c, e, is("adr") ? Referring::pointer : Referring::ref);
}

const Type* check_memory(Checking& c, Expression& call, const Type* expected) {
    const StandardFunction& f = *call.standard;
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
        Expression*& value = call.arguments[i].value;
        if (f.parameter(i).type == Generic::pointer) {
            if (value->type->is_pointer()) continue;
            if (value->type->is_any() && value->place.dialect().seconds_move_moments)
                coerce(c, value, integer_type(32, false));
            if (!value->type) return nullptr;
            if (holds_address(*value->type)) {
                coerce(c, value, pointer_to(c, bits_type(8)));
                continue;
            }
            return c.fail(code::type_does_not_fit, value->place,
                          fmt::format("{} takes a POINTER, not {}", f.name, describe(*value->type)),
                          "write ADR(...) of a variable");
        }
        become_number(c, value);
        if (!value->type->is_integer() && !value->type->is_bits())
            return c.fail(code::type_does_not_fit, value->place,
                          fmt::format("expected a whole number, found {}", describe(*value->type)));
        if (value->type->is_any() && !coerce(c, value, lint_type)) return nullptr;
    }
    if (f.result == Generic::pointer) return &pointer_to(c, bits_type(8));
    if (f.result != Generic::any_int) return &dint_type;
    return expected && expected->kind == Kind::integer ? &expected->plain()
                                                       : &integer_type(32, false);
}

}  // namespace lineshaft::st

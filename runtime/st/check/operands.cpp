#include <cmath>
#include <limits>

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/mixed_signs.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

void reinterpret(Checking& c, Expression& e, Kind from, const Type* expected) {
    for (Expression*& operand : e.operands) {
        if (!operand) continue;
        const Type& type = operand->type->plain();
        if (type.kind != from) continue;
        const bool wider = expected && expected->kind == Kind::integer &&
                           expected->bits > type.bits && !e.place.dialect().reckons_in_registers;
        convert(c, operand,
                from == Kind::integer ? bits_type(type.bits)
                : wider               ? expected->plain()
                                      : integer_type(type.bits, false));
    }
}

void unite_texts(Checking& c, Expression*& a, Expression*& b) {
    const bool are_texts = a->type->kind == Kind::text && b->type->kind == Kind::text;
    if (are_texts && a->type->is_wide != b->type->is_wide)
        coerce(c, a->type->is_wide ? b : a, wide_string_type);
    Expression*& character = a->type->is_character ? a : b;
    Expression*& text = a->type->is_character ? b : a;
    if (!character->type->is_character || text->type->kind != Kind::text) return;
    const bool single = is_constant(*text) && text->constant.text.size() == 1;
    single ? coerce(c, text, char_type) : coerce(c, character, string_type);
}

bool is_beyond_single(const Expression& e, const Type& other, const Type* expected) {
    const bool is_taken =
        e.place.dialect().real_literals_are_lreal || !expected || !is_single(*expected);
    return is_taken && is_single(other) && e.kind == E::constant && e.type->is_real() &&
           std::abs(e.constant.real) > double{std::numeric_limits<float>::max()};
}

bool make_concrete(Checking& c, Expression*& e, const Type& other) {
    const Type& type = *e->type;
    if (!type.is_any()) return true;
    const Type& plain = other.plain();
    const bool whole = e->kind == E::constant && !type.is_real();
    const Wide value = e->constant.integer;
    if (plain.is_real() && !plain.is_any()) return coerce(c, e, plain);
    if (type.is_real()) return coerce(c, e, lreal_type);
    const bool fits = (plain.kind == Kind::integer || plain.kind == Kind::bits) && whole &&
                      value >= smallest(plain) && value <= largest(plain);
    if (fits) return coerce(c, e, plain);
    return coerce(c, e, whole && value > largest(lint_type) ? ulint_type : lint_type);
}

namespace {

/// A ULINT and a signed integer: MatIEC takes that for a ULINT.
bool mixes_signs_of_64(const Expression& e) {
    const Type &a = e.operands[0]->type->plain(), &b = e.operands[1]->type->plain();
    const bool are_integers = a.kind == Kind::integer && b.kind == Kind::integer;
    return e.place.dialect().is_loose && are_integers && a.is_signed != b.is_signed &&
           (a.is_unsigned_64() || b.is_unsigned_64());
}

}  // namespace

const Type* wider_for(const Expression& constant, const Type& typed, const Type* expected) {
    const Wide value = constant.constant.integer;
    const bool is_more_bits =
        constant.type->kind == Kind::any_bits && value >= Wide{1} << typed.plain().bits;
    const bool is_whole = constant.type->kind == Kind::any_integer || is_more_bits;
    const bool is_bits = typed.kind == Kind::bits;
    if (!is_whole || (typed.kind != Kind::integer && !is_bits)) return nullptr;
    const auto holds = [&](const Type& type) {
        return value >= smallest(type) && value <= largest(type);
    };
    if (holds(typed.plain())) return nullptr;
    if (is_bits) {
        for (const int bits : {16, 32, 64})
            if (holds(bits_type(bits))) return &bits_type(bits);
        return nullptr;
    }
    const bool in_registers = constant.place.dialect().reckons_in_registers,
               is_due = expected && expected->is_integer();
    const bool takes_sign = in_registers && typed.plain().bits >= 32;
    const Type* const due = is_due ? &expected->plain() : in_registers ? &int_type : &dint_type;
    for (const Type* wider : {due, &dint_type, &lint_type})
        if (holds(*wider) && (widens(typed, *wider) || (takes_sign && typed.bits == wider->bits)))
            return wider;
    return nullptr;
}

const Type* unite(Checking& c, Expression& e, const Type* expected) {
    Expression *&left = e.operands[0], *&right = e.operands[1];
    const Type &a = *left->type, &b = *right->type;
    const Type* common = nullptr;
    if (a.is_any() && b.is_any()) {
        common = a.is_real() ? &a : b.is_real() ? &b : &any_integer_type;
        if (a.kind == b.kind) common = &a;
    } else if (a.is_any()) {
        common = b.is_code ? &lint_type : &b.plain();
    } else if (b.is_any()) {
        common = a.is_code ? &lint_type : &a.plain();
    } else if (a.has_numbers && b.has_numbers && !same_type(a, b) &&
               e.place.dialect().enumerations_are_numbers) {
        common = &lint_type;
    } else {
        common = met_type(a, b, e.place);
        if (!common && mixes_signs_of_64(e)) common = &ulint_type;
        const bool is_long = (takes_long_numbers(e, a.plain()) && b.plain().kind == Kind::real) ||
                             (takes_long_numbers(e, b.plain()) && a.plain().kind == Kind::real);
        if (!common && is_long) common = &lreal_type;
        if (!common && counts_bits(a, b, e.place)) common = &b;
        if (!common && counts_bits(b, a, e.place)) common = &a;
    }
    const auto real_of = [&](const Type& any, const Type& typed) -> const Type* {
        if (any.kind != Kind::any_real) return nullptr;
        const bool is_number = typed.kind == Kind::integer || counts_bits(typed, any, e.place);
        if (is_number && makes_lreal_of_literals(e.place, expected)) return &lreal_type;
        if (counts_bits(typed, any, e.place)) return typed.bits < 32 ? &real_type : &lreal_type;
        return typed.kind == Kind::integer ? common_type(typed, real_type) : nullptr;
    };
    if (const Type* real = a.is_any() ? real_of(a, b) : real_of(b, a)) common = real;
    if (is_beyond_single(*left, b, expected) || is_beyond_single(*right, a, expected))
        common = &lreal_type;
    if (const Type* wider =
            a.is_any() ? wider_for(*left, b, expected) : wider_for(*right, a, expected))
        if (!expected || !expected->is_integer() || widens(*wider, *expected)) common = wider;
    const auto reckons_in = [&](const Type& type, const Expression& constant) {
        return common && expected && expected->is_integer() && !widens(*common, *expected) &&
               widens(type, *expected) && fits_as_constant(constant, type);
    };
    if (reckons_in(a, *right)) common = &a.plain();
    if (reckons_in(b, *left)) common = &b.plain();
    const bool narrows = expected && is_single(*expected) && common == &lreal_type &&
                         e.place.dialect().real_results_reckon_as_real;
    if (narrows && !same_type(a, lreal_type) && !same_type(b, lreal_type)) common = &real_type;
    if (!common) {
        const bool numbers = a.is_number() && b.is_number();
        return c.fail(
            numbers ? code::conversion_may_lose : code::type_does_not_fit, e.token.place,
            fmt::format("{} does not go with {} and {}", shown(e.op), describe(a), describe(b)),
            numbers
                ? fmt::format("convert one of them: {}_TO_{}(...)", a.plain().name, b.plain().name)
            : a.kind == Kind::enumeration || b.kind == Kind::enumeration
                ? "an enumeration's number is TO_INT(...)"
                : "");
    }
    return coerce(c, left, *common) && coerce(c, right, *common) ? common : nullptr;
}

/// An operator or ABS has left it there, and a conversion that nobody wrote.
static bool is_in_register(const Expression& e) {
    if (e.kind == E::converted) return !e.conversion.is_written && is_in_register(*e.operands[0]);
    if (e.kind == E::unary) return e.op == Word::minus;
    if (e.kind == E::call) return e.standard && same_name(e.standard->name, "abs");
    if (e.kind != E::binary) return false;
    const bool is_logic = e.op == Word::and_ || e.op == Word::or_ || e.op == Word::xor_;
    return !is_logic || is_in_register(*e.operands[0]) || is_in_register(*e.operands[1]);
}

void look_in_register(Checking& c, Expression*& e) {
    const Type& type = e->type->plain();
    const bool is_narrow =
        (type.kind == Kind::integer || type.kind == Kind::bits) && type.bits < 32;
    if (is_narrow && e->place.dialect().reckons_in_registers && is_in_register(*e))
        convert(c, e, dint_type);
}

void keep_width(Checking& c, Expression*& e) {
    const bool is_reckoned = e->kind == E::unary || e->kind == E::binary;
    const bool is_whole =
        e->type && (e->type->kind == Kind::integer || e->type->kind == Kind::bits);
    if (!e->place.dialect().functions_keep_widths || !is_reckoned || !is_whole) return;
    e = make_converted(c, e, *e->type);
    e->conversion.is_written = true;
}

}  // namespace lineshaft::st

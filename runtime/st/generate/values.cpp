#include "runtime/st/generate/values.hpp"

#include "runtime/st/functions/standard.hpp"
#include "runtime/st/generate/places.hpp"

namespace lineshaft::st {

namespace {

/// What is beyond its type is a fault. Of a narrow type as a LINT, which holds it all.
Slot exact(Writing& w, Word op, const Type& type, Slot a, Slot b, Slot wanted) {
    const bool narrow = type.bits < 64;
    const auto pick = [&](Op wide, Op signed_one, Op unsigned_one) {
        return narrow ? wide : type.is_signed ? signed_one : unsigned_one;
    };
    const Op of =
        op == Word::plus    ? pick(Op::add_lint, Op::add_exact_signed, Op::add_exact_unsigned)
        : op == Word::minus ? pick(Op::sub_lint, Op::sub_exact_signed, Op::sub_exact_unsigned)
        : op == Word::times
            ? pick(Op::mul_lint, Op::mul_exact_signed, Op::mul_exact_unsigned)
            : of_type(op == Word::mod_ ? Op::mod_sint : Op::div_sint, narrow ? lint_type : type);
    const Slot made = w.emit(of, narrow ? none : wanted, a, b);
    return narrow ? within(w, type, made) : made;
}

bool is_arithmetic(const Expression& e) {
    if (e.kind == E::unary) return e.op == Word::minus;
    return e.kind == E::binary &&
           (e.op == Word::plus || e.op == Word::minus || e.op == Word::times ||
            e.op == Word::divided || e.op == Word::mod_);
}

Op wide_op(Word op) {
    return op == Word::plus    ? Op::add_dint
           : op == Word::minus ? Op::sub_dint
           : op == Word::times ? Op::mul_dint
           : op == Word::mod_  ? Op::mod_dint
                               : Op::div_dint;
}

bool is_standard(const Expression& e, std::string_view name) {
    return e.kind == E::call && e.standard && same_name(e.standard->name, name);
}

bool is_logic(const Expression& e) {
    return e.kind == E::binary && (e.op == Word::and_ || e.op == Word::or_ || e.op == Word::xor_);
}

/// What CODESYS has in a register of 32 bits, too: ABS, what SHL moves beyond the type, and what is
/// joined with something wide.
bool is_wide_in_codesys(const Writing& w, const Expression& e) {
    if (!e.place.dialect().reckons_in_registers) return false;
    if (is_logic(e)) return is_wide(w, *e.operands[0]) || is_wide(w, *e.operands[1]);
    return is_standard(e, "abs") || is_standard(e, "shl");
}

/// What stands left of `later`, as wide_value() has it.
Slot wide_value_before(Writing& w, const Expression& e, const Expression& later) {
    return is_wide(w, e) ? wide_value(w, e) : value_before(w, e, later);
}

Slot wide_shift(Writing& w, const Expression& e) {
    const Expression &given = *e.arguments[0].value, &places = *e.arguments[1].value;
    const Slot bits = wide_value_before(w, given, places);
    const Slot count = w.emit(Op::and_bits, none, value(w, places), w.constant_slot(31));
    const Slot made = w.emit(Op::shl_32, none, bits, count);
    return e.type->is_signed ? w.emit(Op::wrap_dint, none, made) : made;
}

bool may_be_divided_by_zero(const Expression& e) {
    const Expression& divisor = *e.operands[1];
    return (e.op == Word::divided || e.op == Word::mod_) && !divisor.type->is_real() &&
           (divisor.kind != E::constant || divisor.constant.integer == 0);
}

Slot unary(Writing& w, const Expression& e, Slot wanted) {
    const Slot operand = wide_value(w, *e.operands[0]);
    const Type& type = *e.type;
    if (e.op == Word::plus) return operand;
    if (e.op == Word::not_) {
        if (type.kind == Kind::boolean) return w.emit(Op::not_bool, wanted, operand);
        return w.emit(Op::not_bits, wanted, operand, static_cast<Slot>(type.bits));
    }
    if (type.is_real()) return w.emit(Op::neg_lreal, wanted, operand);
    if (w.options.overflow_faults && type.kind == Kind::integer)
        return exact(w, Word::minus, type, w.constant_slot(0), operand, wanted);
    return w.emit(of_type(Op::neg_sint, type), wanted, operand);
}

/// The block whose place THIS or ADR gives, without a pointer on the way; null: something else.
const Expression* block_of_reference(const Expression& e) {
    if (e.kind == E::converted && !e.conversion.is_attempt)
        return block_of_reference(*e.operands[0]);
    if (e.kind != E::refer || e.operands[0]->type->kind != Kind::block) return nullptr;
    const Expression* at = e.operands[0];
    while (at->kind == E::member || at->kind == E::index) at = at->operands[0];
    return at->kind == E::name || at->kind == E::self ? e.operands[0] : nullptr;
}

/// A reference to a part of something tells the way to it, which THIS of that part does not know.
bool is_compared_by_place(const Expression* left, const Expression* right) {
    return left && right && (left->kind == E::self || right->kind == E::self);
}

/// `<>` of REALs in SCL, where it is FALSE, too, of what is no number.
bool is_false_of_nan(const Expression& e) {
    return e.op == Word::unequal && e.operands[0]->type->is_real() &&
           e.place.dialect().nan_is_not_unequal;
}

Slot comparison(Writing& w, const Expression& e, Slot wanted) {
    const Expression &left = *e.operands[0], &right = *e.operands[1];
    const Expression* const first = block_of_reference(left);
    const Expression* const second = block_of_reference(right);
    if (is_compared_by_place(first, second)) {
        const Slot a = address_of(w, locate(w, *first)), b = address_of(w, locate(w, *second));
        return compare(w, e.op, lint_type, a, b, wanted);
    }
    if (left.type->is_reference())
        return compare(w, e.op, lint_type, compare_references(w, e), w.constant_slot(0), wanted);
    if (left.type->kind == Kind::text) {
        const Slot a = text_before(w, left, right), b = text_address(w, right);
        return compare_texts(w, e.op, a, b, wanted);
    }
    const auto [a, b, type] = sides_of(w, e);
    if (!is_false_of_nan(e)) return compare(w, e.op, type, a, b, wanted);
    const Slot below = w.emit(Op::lt_float, none, a, b), above = w.emit(Op::lt_float, none, b, a);
    return w.emit(Op::or_bits, wanted, below, above);
}

/// AND_THEN, OR_ELSE. Not into a variable, which the right side may read.
Slot lazy(Writing& w, const Expression& e) {
    const Slot to = w.new_temporary();
    value_to(w, *e.operands[0], to);
    std::vector<std::uint32_t> end;
    w.jump(e.op == Word::and_then_ ? Op::jump_unless : Op::jump_if, 0, to, end);
    value_to(w, *e.operands[1], to);
    w.land(end);
    return to;
}

Slot reckon(Writing& w, const Expression& e, Slot a, Slot b, Slot wanted) {
    const Type& type = *e.type;
    const Op from_whole = type.is_unsigned_64() ? Op::lreal_from_unsigned : Op::lreal_from_signed;
    if (type.kind == Kind::time && e.operands[1]->type->is_real()) {
        const Slot real = w.emit(from_whole, none, a);
        const Slot product =
            w.emit(e.op == Word::times ? Op::mul_lreal : Op::div_lreal, none, real, b);
        return w.emit(of_type(Op::round_sint, type), wanted, product);
    }
    if (type.kind == Kind::time && e.operands[0]->type->is_real()) {
        const Slot real = w.emit(from_whole, none, b);
        return w.emit(of_type(Op::round_sint, type), wanted, w.emit(Op::mul_lreal, none, a, real));
    }
    if (e.op == Word::and_) return w.emit(Op::and_bits, wanted, a, b);
    if (e.op == Word::or_) return w.emit(Op::or_bits, wanted, a, b);
    if (e.op == Word::xor_) return w.emit(Op::xor_bits, wanted, a, b);
    if (e.op == Word::power) {
        const bool narrow = type.bits == 32;
        const Slot power = w.emit(Op::power, narrow ? none : wanted, a, b);
        return narrow ? w.emit(Op::narrow, wanted, power) : power;
    }
    const auto of_op = [&](Op plus, Op minus, Op times, Op divided) {
        return e.op == Word::plus    ? plus
               : e.op == Word::minus ? minus
               : e.op == Word::times ? times
                                     : divided;
    };
    if (type.is_real())
        return w.emit(type.bits == 32
                          ? of_op(Op::add_real, Op::sub_real, Op::mul_real, Op::div_real)
                          : of_op(Op::add_lreal, Op::sub_lreal, Op::mul_lreal, Op::div_lreal),
                      wanted, a, b);
    if (w.options.overflow_faults && type.kind == Kind::integer)
        return exact(w, e.op, type, a, b, wanted);
    const bool is_quotient = e.op == Word::divided || e.op == Word::mod_;
    if (is_quotient && is_wide(w, e))
        return w.emit(of_type(Op::wrap_sint, type), wanted, w.emit(wide_op(e.op), none, a, b));
    const Op family = e.op == Word::mod_
                          ? Op::mod_sint
                          : of_op(Op::add_sint, Op::sub_sint, Op::mul_sint, Op::div_sint);
    return w.emit(of_type(family, type), wanted, a, b);
}

/// A quotient or a rest by 0 is 0, and not a fault.
bool is_zero_by_zero(const Expression& e) {
    const ByZero by_zero = e.place.dialect().by_zero;
    return may_be_divided_by_zero(e) &&
           (by_zero == ByZero::is_zero || (by_zero == ByZero::leaves_zero && e.op == Word::mod_));
}

/// 0 where the divisor is; else what `reckon` gives, which may put it into the slot that it gets.
template <class Reckon>
Slot unless_by_zero(Writing& w, Slot b, Reckon reckon) {
    const Slot to = w.new_temporary();
    std::vector<std::uint32_t> end;
    w.put(Op::move, to, w.constant_slot(0));
    w.jump(Op::jump_unless, 0, b, end);
    const Slot made = reckon(to);
    if (made != to) w.put(Op::move, to, made);
    w.land(end);
    return to;
}

/// A field of an instance by its handle, in a vendor's library, where AXIS_REFs are structures.
bool may_be_of_none(const Expression& e) {
    const Expression& of = *e.operands[0];
    return of.kind == E::converted && of.operands[0]->type->kind == Kind::handle &&
           e.place.source->is_library();
}

/// 0 where no instance has been given.
Slot field_of_any(Writing& w, const Expression& e) {
    const Slot address = w.emit(Op::address_of_number, none, value(w, *e.operands[0]->operands[0]));
    return unless_by_zero(w, address, [&](Slot to) {
        return load(w, part(w, {Mode::address, 0, address, 0}, *e.variable), to);
    });
}

Slot binary(Writing& w, const Expression& e, Slot wanted) {
    if (e.op >= Word::less && e.op <= Word::unequal) return comparison(w, e, wanted);
    if (e.op == Word::and_then_ || e.op == Word::or_else_) return lazy(w, e);
    if (e.operands[0]->type->is_reference()) return reference_distance(w, e, wanted);
    if (is_logic(e) && is_wide(w, e))
        return w.emit(of_type(Op::wrap_sint, *e.type), wanted, wide_value(w, e));
    const Slot a = wide_value_before(w, *e.operands[0], *e.operands[1]);
    const Slot b = wide_value(w, *e.operands[1]);
    const auto made = [&](Slot to) { return reckon(w, e, a, b, to); };
    return is_zero_by_zero(e) ? unless_by_zero(w, b, made) : made(wanted);
}

Slot bit(Writing& w, const Expression& e, Slot wanted) {
    return w.emit(Op::get_bits, wanted, value(w, *e.operands[0]), packed(e.bits));
}

Slot character(Writing& w, const Expression& e, Slot wanted) {
    const Expression& text = *e.operands[0];
    const Slot address = text_address(w, text), index = value(w, *e.arguments[0].value);
    const Slot to = w.result(wanted);
    const Dialect& dialect = e.place.dialect();
    if (dialect.texts_are_bytes)
        w.put(Op::text_byte, to, address, index,
              text.type->is_open ? locate(w, text).capacity
                                 : w.constant_slot(text.type->room().number()));
    else {
        const TextRoom room = text.type->room();
        w.put(Op::text_character, to, address, index,
              (dialect.characters_may_be_missing ? room.that_may_miss() : room).number());
    }
    return to;
}

}  // namespace

Slot looked_at(Writing& w, const Expression& e) {
    return is_standard(e, "shl") ? value(w, e) : wide_value(w, e);
}

bool compares_numbers(const Expression& e) {
    const bool is_relation = e.kind == E::binary && e.op >= Word::less && e.op <= Word::unequal;
    if (!is_relation || is_false_of_nan(e)) return false;
    const Type& type = *e.operands[0]->type;
    return type.kind != Kind::text && !type.is_reference() &&
           !is_compared_by_place(block_of_reference(*e.operands[0]),
                                 block_of_reference(*e.operands[1]));
}

Sides sides_of(Writing& w, const Expression& e) {
    const Expression &left = *e.operands[0], &right = *e.operands[1];
    const bool is_kept = is_standard(left, "shl") || !is_wide(w, left);
    const Slot first = is_kept ? value_before(w, left, right) : wide_value(w, left);
    return {first, looked_at(w, right), right.type->is_unsigned_64() ? *right.type : *left.type};
}

Op comparison_op(Word relation, const Type& type) {
    const auto pick = [&](Op real, Op of_unsigned, Op other) {
        return type.is_real() ? real : type.is_unsigned_64() ? of_unsigned : other;
    };
    if (relation == Word::equal) return pick(Op::eq_float, Op::eq_word, Op::eq_word);
    if (relation == Word::unequal) return pick(Op::ne_float, Op::ne_word, Op::ne_word);
    if (relation == Word::less || relation == Word::greater)
        return pick(Op::lt_float, Op::lt_unsigned, Op::lt_signed);
    return pick(Op::le_float, Op::le_unsigned, Op::le_signed);
}

Slot compare(Writing& w, Word relation, const Type& type, Slot a, Slot b, Slot wanted) {
    if (is_exchanged(relation)) std::swap(a, b);
    return w.emit(comparison_op(relation, type), wanted, a, b);
}

Slot compare_texts(Writing& w, Word relation, Slot a, Slot b, Slot wanted) {
    const Slot order = w.emit(Op::text_compare, none, a, b);
    return compare(w, relation, lint_type, order, w.constant_slot(0), wanted);
}

Slot value(Writing& w, const Expression& e, Slot wanted) {
    switch (e.kind) {
        case E::constant:
            return w.constant_slot(*e.type, e.constant);
        case E::index:
            if (e.is_character()) return character(w, e, wanted);
            return load(w, locate(w, e), wanted);
        case E::member:
            if (may_be_of_none(e)) return field_of_any(w, e);
            update_timer(w, e);
            if (is_finer_than_ms(e.operands[0]->type, *e.type, e.place))
                return whole_ms(w, load(w, locate(w, e)), e.place, wanted);
            [[fallthrough]];
        case E::name:
        case E::deref:
            return load(w, locate(w, e), wanted);
        case E::bit:
            return bit(w, e, wanted);
        case E::call:
            return call(w, e, wanted);
        case E::unary:
            return unary(w, e, wanted);
        case E::binary:
            return binary(w, e, wanted);
        case E::converted:
            return converted(w, e, wanted);
        case E::typed:
        case E::list:
        case E::repeated:
        case E::refer:
        case E::self:
            break;
    }
    return w.constant_slot(0);
}

bool is_wide(const Writing& w, const Expression& e) {
    const bool is_narrow = e.type && (e.type->kind == Kind::integer || e.type->is_bits()) &&
                           e.type->bits < e.place.dialect().reckons_in;
    if (!is_narrow || w.options.overflow_faults) return false;
    if (e.kind == E::converted) return !e.conversion.is_written && is_wide(w, *e.operands[0]);
    return is_arithmetic(e) || is_wide_in_codesys(w, e);
}

Slot wide_value(Writing& w, const Expression& e) {
    if (!is_wide(w, e)) return value(w, e);
    if (e.kind == E::converted) return wide_value(w, *e.operands[0]);
    if (e.kind == E::unary) return w.emit(Op::neg_dint, none, wide_value(w, *e.operands[0]));
    if (is_standard(e, "abs"))
        return w.emit(Op::abs_signed, none, wide_value(w, *e.arguments[0].value));
    if (e.kind == E::call) return wide_shift(w, e);
    const Slot a = wide_value_before(w, *e.operands[0], *e.operands[1]);
    const Slot b = wide_value(w, *e.operands[1]);
    if (is_logic(e)) return reckon(w, e, a, b, none);
    const auto made = [&](Slot to) { return w.emit(wide_op(e.op), to, a, b); };
    return is_zero_by_zero(e) ? unless_by_zero(w, b, made) : made(none);
}

void value_to(Writing& w, const Expression& e, Slot to) {
    const Slot from = value(w, e, to);
    if (from != to) w.put(Op::move, to, from);
}

Slot value_before(Writing& w, const Expression& e, const Expression& later) {
    const Slot slot = value(w, e);
    const Expression* from = &e;  // a wider value, and that of '+', may be in the variable's slot
    while (from->kind == E::converted || from->kind == E::unary) from = from->operands[0];
    const bool is_variable =
        from->kind == E::name || from->kind == E::member || from->kind == E::index;
    return is_variable && has_call(later) ? w.emit(Op::move, none, slot) : slot;
}

Slot within(Writing& w, const Type& type, Slot slot) {
    const auto least = static_cast<std::int64_t>(smallest(type));
    const auto count = static_cast<std::uint64_t>(largest(type) - smallest(type)) + 1;
    if (count > 0) w.put(Op::within, 0, slot, w.table({least, count, 1}));
    return slot;
}

}  // namespace lineshaft::st

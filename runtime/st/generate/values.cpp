#include <algorithm>

#include "runtime/st/generate/generator_class.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using E = Expression::Kind;
using Mode = Location::Mode;

}  // namespace

/// The families of integers stand in the order SINT, INT, DINT, LINT, USINT, UINT, UDINT, ULINT.
Op of_type(Op first, const Type& type) {
    constexpr int distance = static_cast<int>(Op::add_int) - static_cast<int>(Op::add_sint);
    int width = 0;
    while ((8 << width) < type.bits) ++width;
    const int number = type.is_signed ? width : width + 4;
    return static_cast<Op>(static_cast<int>(first) + number * distance);
}

Slot Generator::emit(Op op, Slot wanted, Slot b, Slot c) {
    const Slot to = result(wanted);
    put(op, to, b, c);
    return to;
}

/// The slot that has the value: `wanted` if something had to be computed, else where it is.
Slot Generator::value(const Expression& e, Slot wanted) {
    switch (e.kind) {
        case E::constant:
            return constant_slot(*e.type, e.constant);
        case E::index:
            if (e.is_character()) return character(e, wanted);
            [[fallthrough]];
        case E::name:
        case E::member:
            return load(locate(e), wanted);
        case E::bit:
            return bit(e, wanted);
        case E::call:
            return call(e, wanted);
        case E::unary:
            return unary(e, wanted);
        case E::binary:
            return binary(e, wanted);
        case E::converted:
            return converted(e, wanted);
        default:
            return constant_slot(0);
    }
}

void Generator::value_to(const Expression& e, Slot to) {
    const Slot from = value(e, to);
    if (from != to) put(Op::move, to, from);
}

/// A value that stays what it is while `later` is computed: operands go from left to right.
Slot Generator::value_before(const Expression& e, const Expression& later) {
    const Slot slot = value(e);
    const bool is_variable = e.kind == E::name || e.kind == E::member;
    return is_variable && has_call(later) ? emit(Op::move, none, slot) : slot;
}

Slot Generator::unary(const Expression& e, Slot wanted) {
    const Slot operand = value(*e.operands[0]);
    const Type& type = *e.type;
    if (e.op == Word::plus) return operand;
    if (e.op == Word::not_) {
        if (type.kind == Kind::boolean) return emit(Op::not_bool, wanted, operand);
        return emit(Op::not_bits, wanted, operand, static_cast<Slot>(type.bits));
    }
    if (type.is_real()) return emit(Op::neg_lreal, wanted, operand);
    if (options_.overflow_faults && type.kind == Kind::integer)
        return exact(Word::minus, type, constant_slot(0), operand, wanted);
    return emit(of_type(Op::neg_sint, type), wanted, operand);
}

Slot Generator::binary(const Expression& e, Slot wanted) {
    if (e.op >= Word::less && e.op <= Word::unequal) return comparison(e, wanted);
    if (e.op == Word::and_then_ || e.op == Word::or_else_) return lazy(e);
    const Type& type = *e.type;
    Slot a = value_before(*e.operands[0], *e.operands[1]), b = value(*e.operands[1]);
    if (type.kind == Kind::time && e.operands[1]->type->is_real()) {
        const Slot real = emit(Op::lreal_from_signed, none, a);
        const Slot product =
            emit(e.op == Word::times ? Op::mul_lreal : Op::div_lreal, none, real, b);
        return emit(Op::round_lint, wanted, product);
    }
    if (type.kind == Kind::time && e.operands[0]->type->is_real()) {
        const Slot real = emit(Op::lreal_from_signed, none, b);
        return emit(Op::round_lint, wanted, emit(Op::mul_lreal, none, a, real));
    }
    if (e.op == Word::and_) return emit(Op::and_bits, wanted, a, b);
    if (e.op == Word::or_) return emit(Op::or_bits, wanted, a, b);
    if (e.op == Word::xor_) return emit(Op::xor_bits, wanted, a, b);
    if (e.op == Word::power) {
        const bool narrow = type.bits == 32;
        const Slot power = emit(Op::power, narrow ? none : wanted, a, b);
        return narrow ? emit(Op::narrow, wanted, power) : power;
    }
    const auto of_op = [&](Op plus, Op minus, Op times, Op divided) {
        return e.op == Word::plus    ? plus
               : e.op == Word::minus ? minus
               : e.op == Word::times ? times
                                     : divided;
    };
    if (type.is_real())
        return emit(type.bits == 32
                        ? of_op(Op::add_real, Op::sub_real, Op::mul_real, Op::div_real)
                        : of_op(Op::add_lreal, Op::sub_lreal, Op::mul_lreal, Op::div_lreal),
                    wanted, a, b);
    if (options_.overflow_faults && type.kind == Kind::integer)
        return exact(e.op, type, a, b, wanted);
    const Op family = e.op == Word::mod_
                          ? Op::mod_sint
                          : of_op(Op::add_sint, Op::sub_sint, Op::mul_sint, Op::div_sint);
    return emit(of_type(family, type), wanted, a, b);
}

Slot Generator::comparison(const Expression& e, Slot wanted) {
    const bool texts = e.operands[0]->type->kind == Kind::text;
    const Type& type = texts ? lint_type : *e.operands[0]->type;
    Slot a = none, b = none;
    if (texts) {
        const Slot left = text_address(*e.operands[0]), right = text_address(*e.operands[1]);
        a = emit(Op::text_compare, none, left, right);
        b = constant_slot(0);
    } else {
        a = value_before(*e.operands[0], *e.operands[1]), b = value(*e.operands[1]);
    }
    if (e.op == Word::greater || e.op == Word::greater_or_equal) std::swap(a, b);
    if (e.op == Word::equal || e.op == Word::unequal) {
        const bool is_equal = e.op == Word::equal;
        if (type.is_real()) return emit(is_equal ? Op::eq_float : Op::ne_float, wanted, a, b);
        return emit(is_equal ? Op::eq_word : Op::ne_word, wanted, a, b);
    }
    const bool less = e.op == Word::less || e.op == Word::greater;
    if (type.is_real()) return emit(less ? Op::lt_float : Op::le_float, wanted, a, b);
    if (type.is_unsigned_64()) return emit(less ? Op::lt_unsigned : Op::le_unsigned, wanted, a, b);
    return emit(less ? Op::lt_signed : Op::le_signed, wanted, a, b);
}

/// What is beyond its type is a fault. Of a narrow type as a LINT, which holds it all.
Slot Generator::exact(Word op, const Type& type, Slot a, Slot b, Slot wanted) {
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
    const Slot made = emit(of, narrow ? none : wanted, a, b);
    return narrow ? within(type, made) : made;
}

Slot Generator::within(const Type& type, Slot slot) {
    const auto least = static_cast<std::int64_t>(smallest(type));
    const auto count = static_cast<std::uint64_t>(largest(type) - smallest(type)) + 1;
    put(Op::within, 0, slot, table({least, count, 1}));
    return slot;
}

/// AND_THEN, OR_ELSE. Not into a variable, which the right side may read.
Slot Generator::lazy(const Expression& e) {
    const Slot to = new_temporary();
    value_to(*e.operands[0], to);
    std::vector<std::uint32_t> end;
    jump(e.op == Word::and_then_ ? Op::jump_unless : Op::jump_if, 0, to, end);
    value_to(*e.operands[1], to);
    land(end);
    return to;
}

Slot Generator::bit(const Expression& e, Slot wanted) {
    return emit(Op::get_bits, wanted, value(*e.operands[0]), static_cast<Slot>(e.constant.integer));
}

Slot Generator::character(const Expression& e, Slot wanted) {
    const Expression& text = *e.operands[0];
    const Slot address = text_address(text), index = value(*e.arguments[0].value);
    const Slot to = result(wanted);
    put(Op::text_character, to, address, index, text.type->length);
    return to;
}

void Generator::store_bits(const Expression& target, Slot bits) {
    const Location whole = locate(*target.operands[0]);
    land();
    const Type& type = *target.operands[0]->type;
    const Slot slot = load(whole);
    put(Op::set_bits, slot, bits, static_cast<Slot>(target.constant.integer));
    if (type.is_signed && type.bits < 64) put(of_type(Op::wrap_sint, type), slot, slot);
    if (whole.mode != Mode::slot) store(whole, slot);
}

// Conversions.

Slot Generator::converted(const Expression& e, Slot wanted) {
    const Expression& operand = *e.operands[0];
    if (e.type->kind == Kind::handle)
        return emit(Op::set_global_number, wanted, static_cast<Slot>(operand.variable->global));
    if (operand.type->kind == Kind::text) {
        const Slot text = text_address(operand);
        if (e.type->kind == Kind::real) {
            const Slot real = emit(Op::real_of_text, none, text);
            return e.type->bits == 32 ? emit(Op::narrow, wanted, real) : real;
        }
        if (e.type->kind == Kind::boolean) return emit(Op::truth_of_text, wanted, text);
        if (e.type->is_time())
            return emit(Op::time_of_text, wanted, text, static_cast<Slot>(e.type->kind));
        if (e.type->is_character) {
            const Slot to = result(wanted);
            put(Op::text_character, to, text, constant_slot(1), 1);
            return to;
        }
        return emit(of_type(Op::wrap_sint, e.type->plain()), wanted,
                    emit(Op::integer_of_text, none, text));
    }
    return convert(value(operand), *operand.type, *e.type, e.op == Word::divided, wanted);
}

Slot Generator::look_up(Slot slot, const std::vector<std::int64_t>& numbers) {
    const std::uint64_t first = code_.numbers.size();
    code_.numbers.insert(code_.numbers.end(), numbers.begin(), numbers.end());
    return emit(Op::look_up, none, slot, table({0, numbers.size(), 1, first}));
}

Slot Generator::convert(Slot slot, const Type& given_from, const Type& given_to, bool truncates,
                        Slot wanted) {
    const Type &from = given_from.plain(), &to = given_to.plain();
    if (given_to.is_subrange) {
        const Slot whole = convert(slot, from, to, truncates, none);
        put(Op::within, 0, whole,
            table({given_to.lower, static_cast<std::uint64_t>(given_to.upper - given_to.lower) + 1,
                   1}));
        return whole;
    }
    if (from.kind == Kind::enumeration && !from.counted) {
        slot = look_up(slot, from.numbers);
        return convert(slot, *from.base, to, truncates, wanted);
    }
    if (to.kind == Kind::enumeration) {
        if (!to.of_number.empty() && from.is_integer()) slot = look_up(slot, to.of_number);
        if (from.is_real()) slot = convert_real(slot, from, lint_type, truncates, none);
        put(Op::within, 0, slot, table({0, to.values.size(), 1}));
        return slot;
    }
    if (from.is_time() && to.is_time()) return convert_date(slot, from, to, wanted);
    if (from.is_time() || to.is_time()) return convert_time(slot, from, to, wanted);
    if (from.is_real() || to.is_real()) return convert_real(slot, from, to, truncates, wanted);
    if (to.kind == Kind::boolean) return emit(Op::ne_word, wanted, slot, constant_slot(0));
    if (widens(from, to) || from.kind == Kind::boolean || from.kind == Kind::enumeration)
        return slot;
    return emit(of_type(Op::wrap_sint, to), wanted, slot);
}

Slot Generator::convert_real(Slot slot, const Type& from, const Type& to, bool truncates,
                             Slot wanted) {
    if (from.is_real() && to.is_real())
        return to.bits < from.bits ? emit(Op::narrow, wanted, slot) : slot;
    if (to.is_real()) {
        if (from.kind == Kind::bits && from.bits == to.bits)
            return to.bits == 32 ? emit(Op::real_of_bits, wanted, slot) : slot;
        const bool big = from.is_unsigned_64();
        if (to.bits == 32)
            return emit(big ? Op::real_from_unsigned : Op::real_from_signed, wanted, slot);
        return emit(big ? Op::lreal_from_unsigned : Op::lreal_from_signed, wanted, slot);
    }
    if (to.kind == Kind::boolean) return emit(Op::ne_float, wanted, slot, constant_slot(0));
    if (to.kind == Kind::bits && from.bits == to.bits)
        return to.bits == 32 ? emit(Op::real_bits, wanted, slot) : slot;
    if (truncates) slot = emit(Op::truncate, none, slot);
    return emit(of_type(Op::round_sint, to), wanted, slot);
}

/// Of a DT its DATE and its TOD; all others keep their ns.
Slot Generator::convert_date(Slot slot, const Type& from, const Type& to, Slot wanted) {
    if (from.kind != Kind::moment || (to.kind != Kind::date && to.kind != Kind::clock)) return slot;
    const Slot day = constant_slot(86'400'000'000'000);
    const Slot rest = emit(Op::mod_lint, none, slot, day);
    const Slot above = emit(Op::add_lint, none, rest, day);
    const bool is_date = to.kind == Kind::date;
    const Slot clock = emit(Op::mod_lint, is_date ? none : wanted, above, day);
    return is_date ? emit(Op::sub_lint, wanted, slot, clock) : clock;
}

/// A time is in ns as an integer of 64 bits. As any other number a TIME and a TOD are in ms, as
/// IEC 61131-3's vendors have it, a DT and a DATE in s, and an LTIME as a real number in ns; in 16
/// bits a DATE is in days since 1990, as Siemens has it.
Slot Generator::convert_time(Slot slot, const Type& from, const Type& to, Slot wanted) {
    const Type &time = from.is_time() ? from : to, &number = from.is_time() ? to : from;
    if (to.kind == Kind::boolean) return emit(Op::ne_word, wanted, slot, constant_slot(0));
    const bool in_seconds = time.kind == Kind::date || time.kind == Kind::moment;
    if (number.is_real()) {
        const double unit = in_seconds ? 1e9 : time.name == "LTIME" ? 1 : 1e6;
        const Slot one = constant_slot(lreal_type, {.real = unit});
        if (from.is_real())
            return emit(Op::round_lint, wanted, emit(Op::mul_lreal, none, slot, one));
        const Slot real = emit(Op::lreal_from_signed, none, slot);
        const Slot counted = emit(Op::div_lreal, wanted, real, one);
        return to.bits == 32 ? emit(Op::narrow, wanted, counted) : counted;
    }
    if (number.bits == 64) return slot;
    constexpr std::uint64_t day = 86'400'000'000'000;
    const bool in_days = time.kind == Kind::date && number.bits == 16;
    const Slot unit = constant_slot(in_days ? day : in_seconds ? 1'000'000'000 : 1'000'000);
    const Slot start = constant_slot(in_days ? 7305 * day : 0);
    if (to.is_time()) {
        if (!in_days) return emit(Op::mul_lint, wanted, slot, unit);
        return emit(Op::add_lint, wanted, emit(Op::mul_lint, none, slot, unit), start);
    }
    if (in_days) slot = emit(Op::sub_lint, none, slot, start);
    return emit(of_type(Op::wrap_sint, to), wanted, emit(Op::div_lint, none, slot, unit));
}

// Places.

Location Generator::locate(const Expression& e) {
    if (e.kind == E::member) return part(locate(*e.operands[0]), *e.variable);
    if (e.kind == E::index) return locate_element(e);
    if (e.kind == E::call) return {Mode::slot, call(e, none)};
    if (e.kind == E::converted) return locate_object(e);
    const Variable& variable = *e.variable;
    if (variable.space == Space::reference) {
        const bool of_block = routine_->owner && variable.of != routine_->pou;
        if (of_block) put(Op::bound, 0, variable.slot);
        return {.mode = Mode::address, .index = variable.slot, .capacity = variable.slot + 1};
    }
    if (variable.space == Space::global) {
        const Slot address = new_temporary();
        put(Op::set_global, address, static_cast<Slot>(variable.global));
        return {Mode::address, 0, address, variable.slot};
    }
    return {Mode::slot, variable.slot};
}

/// What a reference refers to.
Location Generator::locate_object(const Expression& e) {
    const Slot address = emit(Op::address_of_number, none, value(*e.operands[0]));
    put(Op::bound, 0, address);
    return {Mode::address, 0, address, 0};
}

Location Generator::part(Location of, const Variable& member) {
    if (member.is_byte) {
        if (of.mode == Mode::indexed) of = as_address(of);
        of.byte = member.byte;
        return of;
    }
    if (member.space == Space::reference) {
        const Slot address = load(part(of, member.slot));
        put(Op::bound, 0, address);
        Location made{.mode = Mode::address, .index = address};
        if (member.type->is_open) made.capacity = load(part(of, member.slot + 1));
        return made;
    }
    return part(of, member.slot);
}

Location Generator::part(Location of, std::uint32_t slots) {
    (of.mode == Mode::address ? of.offset : of.slot) += slots;
    return of;
}

Location Generator::locate_element(const Expression& e) {
    Location at = locate(*e.operands[0]);
    const Type* type = e.operands[0]->type;
    Slot index = none;
    for (const Argument& argument : e.arguments) {
        const std::uint32_t stride = slots_of(*type->element);
        const Expression& number = *argument.value;
        if (number.kind == E::constant) {
            const auto place = static_cast<std::uint32_t>(number.constant.integer - type->lower);
            at = part(at, place * stride);
        } else {
            const IndexTable made{
                type->lower, static_cast<std::uint64_t>(type->upper - type->lower) + 1, stride};
            const Slot given = value(number);
            if (index == none)
                index = emit(Op::index, none, given, table(made));
            else
                put(Op::index_more, index, given, table(made));
        }
        type = type->element;
    }
    if (index == none) return at;
    if (at.mode == Mode::slot) return {Mode::indexed, at.slot, index};
    if (at.mode == Mode::indexed) {
        const Slot sum = emit(Op::offset_by, none, at.index, index);
        return {Mode::indexed, at.slot, sum};
    }
    return {Mode::address, 0, emit(Op::offset_by, none, at.index, index), at.offset};
}

Location Generator::as_address(Location location) {
    if (location.mode == Mode::address) return location;
    Slot address = emit(Op::set_address, none, location.slot);
    if (location.mode == Mode::indexed)
        address = emit(Op::offset_by, none, address, location.index);
    Location made{Mode::address, 0, address, 0};
    made.byte = location.byte;
    return made;
}

Slot Generator::address_of(Location location) {
    const Location at = as_address(location);
    return at.offset == 0 ? at.index : emit(Op::offset, none, at.index, at.offset);
}

Slot Generator::capacity_of(const Location& text, const Type& type) {
    return type.is_open ? text.capacity : constant_slot(type.length);
}

Slot Generator::load(const Location& from, Slot wanted) {
    if (from.byte && from.mode == Mode::slot)
        return emit(Op::get_byte, wanted, from.slot, *from.byte);
    if (from.byte) return emit(Op::load_byte, wanted, from.index, from.offset * 8 + *from.byte);
    if (from.mode == Mode::slot) return from.slot;
    if (from.mode == Mode::indexed) return emit(Op::load_at, wanted, from.slot, from.index);
    return emit(Op::load, wanted, from.index, from.offset);
}

void Generator::store(const Location& to, Slot from) {
    if (to.byte && to.mode == Mode::slot) return put(Op::set_byte, from, to.slot, *to.byte);
    if (to.byte) return put(Op::store_byte, from, to.index, to.offset * 8 + *to.byte);
    if (to.mode == Mode::indexed) return put(Op::store_at, from, to.slot, to.index);
    if (to.mode == Mode::address) return put(Op::store, from, to.index, to.offset);
    if (to.slot != from) put(Op::move, to.slot, from);
}

void Generator::copy(const Location& to, const Location& from, std::uint32_t slots) {
    const bool direct_to = to.mode == Mode::slot, direct_from = from.mode == Mode::slot;
    if (direct_to && direct_from) return put(Op::copy, to.slot, from.slot, slots);
    if (direct_to) return put(Op::copy_from, to.slot, address_of(from), slots);
    if (direct_from) return put(Op::copy_to, address_of(to), from.slot, slots);
    put(Op::copy_between, address_of(to), address_of(from), slots);
}

void Generator::assign(const Location& to, const Type& type, const Expression& from) {
    if (!type.is_scalar()) return copy_value(to, type, from);
    if (to.mode == Mode::slot && !to.byte) return value_to(from, to.slot);
    store(to, value(from));
}

/// An array, a structure, a text.
void Generator::copy_value(const Location& to, const Type& type, const Expression& from) {
    if (type.kind == Kind::text) {
        const Slot text = text_address(from);
        return put(Op::text_copy, address_of(to), text, capacity_of(to, type));
    }
    if (from.kind == E::call) {
        const Location made = from.routine ? Location{Mode::slot, call(from, none)}
                                           : Location{Mode::address, 0, standard(from, none)};
        return copy(to, made, slots_of(type));
    }
    copy(to, locate(from), slots_of(type));
}

}  // namespace lineshaft::st

#include <algorithm>

#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/values.hpp"

namespace lineshaft::st {

namespace {

Slot look_up(Writing& w, Slot slot, const std::vector<std::int64_t>& numbers,
             std::int64_t least = 0) {
    const std::uint64_t first = w.code.numbers.size();
    w.code.numbers.insert(w.code.numbers.end(), numbers.begin(), numbers.end());
    return w.emit(Op::look_up, none, slot, w.table({least, numbers.size(), 1, first}));
}

/// A number that is none of them gives a number that is no place.
Slot look_up_place(Writing& w, Slot slot, const std::vector<std::int64_t>& numbers) {
    const auto [least, most] = std::ranges::minmax(numbers);
    std::vector<std::int64_t> places(static_cast<std::size_t>(most - least) + 1, -1);
    for (std::size_t i = numbers.size(); i > 0; --i)
        places[static_cast<std::size_t>(numbers[i - 1] - least)] = static_cast<std::int64_t>(i) - 1;
    return look_up(w, slot, places, least);
}

/// In SCL and CODESYS what is beyond the type leaves bits there: in SCL its lowest.
Op bits_left(const Dialect& dialect, const Type& to, bool truncates) {
    if (dialect.beyond_type == BeyondType::lowest_bits) return Op::lowest_bits;
    if (to.bits == 64) return Op::left_in_64;
    return truncates ? Op::truncated_in_32 : Op::left_in_32;
}

/// TwinCAT stops where a register does not hold the number, and else keeps as many bits of it.
bool keeps_bits_of_register(const Source* source) {
    return source && source->dialect.keeps_bits_of_register && !source->is_prelude();
}

Slot kept_of_register(Writing& w, Slot slot, const Type& to, Slot wanted) {
    if (to.bits == 64) return w.emit(to.is_signed ? Op::round_lint : Op::left_in_64, wanted, slot);
    const bool is_long = to.bits == 32 && !to.is_signed;
    const Slot whole = w.emit(is_long ? Op::round_lint : Op::round_dint, none, slot);
    return w.emit(of_type(Op::wrap_sint, to), wanted, whole);
}

Slot nearest(Writing& w, Slot slot, const Type& to, bool truncates, Slot wanted) {
    const auto* source = w.place.source;
    if (keeps_bits_of_register(source)) return kept_of_register(w, slot, to, wanted);
    const bool are_left =
        source && source->dialect.beyond_type != BeyondType::fault && !source->is_prelude();
    if (!are_left) return w.emit(of_type(Op::round_sint, to), wanted, slot);
    const Op left = bits_left(source->dialect, to, truncates);
    if (to.bits == 64) return w.emit(left, wanted, slot);
    return w.emit(of_type(Op::wrap_sint, to), wanted, w.emit(left, none, slot));
}

Slot convert_real(Writing& w, Slot slot, const Type& from, const Type& to, bool truncates,
                  Slot wanted) {
    if (from.is_real() && to.is_real())
        return to.bits < from.bits ? w.emit(Op::narrow, wanted, slot) : slot;
    if (to.is_real()) {
        if (from.kind == Kind::bits && from.bits == to.bits)
            return to.bits == 32 ? w.emit(Op::real_of_bits, wanted, slot) : slot;
        const bool big = from.is_unsigned_64();
        if (to.bits == 32)
            return w.emit(big ? Op::real_from_unsigned : Op::real_from_signed, wanted, slot);
        return w.emit(big ? Op::lreal_from_unsigned : Op::lreal_from_signed, wanted, slot);
    }
    if (to.kind == Kind::boolean) return w.emit(Op::ne_float, wanted, slot, w.constant_slot(0));
    if (to.kind == Kind::bits && from.bits == to.bits)
        return to.bits == 32 ? w.emit(Op::real_bits, wanted, slot) : slot;
    if (truncates) slot = w.emit(Op::truncate, none, slot);
    return nearest(w, slot, to, truncates, wanted);
}

/// A DT and a DATE give their DATE and their TOD; all others keep their ns.
Slot convert_date(Writing& w, Slot slot, const Type& from, const Type& to, Slot wanted) {
    const bool has_day = from.kind == Kind::moment || from.kind == Kind::date;
    if (!has_day || (to.kind != Kind::date && to.kind != Kind::clock)) return slot;
    const Slot day = w.constant_slot(86'400'000'000'000);
    const Slot rest = w.emit(Op::mod_lint, none, slot, day);
    const Slot above = w.emit(Op::add_lint, none, rest, day);
    const bool is_date = to.kind == Kind::date;
    const Slot clock = w.emit(Op::mod_lint, is_date ? none : wanted, above, day);
    return is_date ? w.emit(Op::sub_lint, wanted, slot, clock) : clock;
}

/// ns of what a number counts of a time.
using Unit = std::uint64_t;
constexpr Unit of_ns = 1, of_ms = 1'000'000, of_seconds = 1'000'000'000,
               of_days = 86'400'000'000'000;

/// As a number a TIME and a TOD are in ms, as IEC 61131-3's vendors have it, a DT and a DATE in s,
/// the long ones in ns.
Unit unit_of(const Type& time) {
    const bool in_seconds = time.kind == Kind::date || time.kind == Kind::moment;
    return time.counts_ns ? of_ns : in_seconds ? of_seconds : of_ms;
}

/// A whole number; days are those since 1990, as Siemens has a DATE in 16 bits.
Slot convert_counted(Writing& w, Slot slot, const Type& to, Unit counted, Slot wanted) {
    const Slot unit = w.constant_slot(counted), start = w.constant_slot(7305 * of_days);
    const bool in_days = counted == of_days;
    if (to.is_time()) {
        if (!in_days) return w.emit(Op::mul_lint, wanted, slot, unit);
        return w.emit(Op::add_lint, wanted, w.emit(Op::mul_lint, none, slot, unit), start);
    }
    if (in_days) slot = w.emit(Op::sub_lint, none, slot, start);
    return w.emit(of_type(Op::wrap_sint, to), wanted, w.emit(Op::div_lint, none, slot, unit));
}

Slot convert_real_time(Writing& w, Slot slot, const Type& from, const Type& to, Unit counted,
                       Slot wanted) {
    const Slot unit = w.constant_slot(lreal_type, {.real = static_cast<double>(counted)});
    if (to.is_time()) return nearest(w, w.emit(Op::mul_lreal, none, slot, unit), to, false, wanted);
    const Slot real =
        w.emit(from.is_unsigned_64() ? Op::lreal_from_unsigned : Op::lreal_from_signed, none, slot);
    const Slot count = w.emit(Op::div_lreal, wanted, real, unit);
    return to.bits == 32 ? w.emit(Op::narrow, wanted, count) : count;
}

/// A time is in ns as an integer of 64 bits, but in dialects that count those as all others.
Slot convert_time(Writing& w, Slot slot, const Type& from, const Type& to, Slot wanted) {
    const Type &time = from.is_time() ? from : to, &number = from.is_time() ? to : from;
    if (to.kind == Kind::boolean) return w.emit(Op::ne_word, wanted, slot, w.constant_slot(0));
    if (number.is_real()) return convert_real_time(w, slot, from, to, unit_of(time), wanted);
    const bool in_seconds = w.place.source && w.place.dialect().words_of_dates_count_seconds;
    const bool in_days = time.kind == Kind::date && number.bits == 16 && !in_seconds;
    return number.bits == 64
               ? slot
               : convert_counted(w, slot, to, in_days ? of_days : unit_of(time), wanted);
}

/// MatIEC counts all times in seconds.
bool is_of_matiec(const Expression& e) {
    const Type &from = e.operands[0]->type->plain(), &to = e.type->plain();
    return e.place.dialect().functions_are_in_c && from.is_time() != to.is_time() &&
           to.kind != Kind::boolean;
}

Slot convert_seconds(Writing& w, Slot slot, const Type& from, const Type& to, Slot wanted) {
    const bool is_real = from.is_real() || to.is_real();
    return is_real ? convert_real_time(w, slot, from, to, of_seconds, wanted)
                   : convert_counted(w, slot, to, of_seconds, wanted);
}

/// A REAL, rounded: MatIEC has 0 below 0 where the number has no sign, and then the last bits.
bool is_cut_by_matiec(const Expression& e) {
    const Type &from = e.operands[0]->type->plain(), &to = e.type->plain();
    const bool is_whole = to.is_integer() || (to.is_bits() && to.bits != from.bits);
    return e.place.dialect().functions_are_in_c && from.is_real() && is_whole &&
           !e.conversion.truncates;
}

Slot cut_by_matiec(Writing& w, Slot real, const Type& to, Slot wanted) {
    const bool has_sign = to.is_integer() && to.is_signed;
    const Slot whole = w.emit(Op::round_lint, none, real);
    const Slot cut = has_sign ? whole : w.emit(Op::max_signed, none, whole, w.constant_slot(0));
    return to.bits == 64 ? cut : w.emit(of_type(Op::wrap_sint, to), wanted, cut);
}

bool is_whole_number(const Type& type) {
    return (type.is_integer() || type.is_bits()) && !type.is_character;
}

/// A DATE and a whole number of any width do in SCL.
bool counts_days(const Expression& e) {
    const Type &from = e.operands[0]->type->plain(), &to = e.type->plain();
    const Type &time = from.is_time() ? from : to, &number = from.is_time() ? to : from;
    return e.place.dialect().dates_count_days && !e.place.source->is_prelude() &&
           from.is_time() != to.is_time() && time.kind == Kind::date && is_whole_number(number);
}

/// A TIME, a TOD, a DT or a DATE and 64 bits are, in CODESYS also 16, which are no days there; the
/// prelude reckons in ns.
bool is_counted(const Expression& e) {
    const Dialect& dialect = e.place.dialect();
    if (!dialect.long_numbers_count_time || e.place.source->is_prelude()) return false;
    const Type &from = e.operands[0]->type->plain(), &to = e.type->plain();
    const Type &time = from.is_time() ? from : to, &number = from.is_time() ? to : from;
    const bool has_width = number.bits == 64 || (number.bits == 16 && dialect.times_count_ms);
    return from.is_time() != to.is_time() && !time.counts_ns && has_width &&
           (number.is_integer() || number.is_bits());
}

/// Made of something else in CODESYS and SCL, whose TIME and TOD are whole ms, in SCL also DT, in
/// CODESYS that whole seconds, and DATE whole days.
bool is_whole(const Expression& e) {
    const Type &from = *e.operands[0]->type, &to = e.type->plain();
    const Dialect& dialect = e.place.dialect();
    const bool is_moment = to.kind == Kind::moment && from.kind == Kind::moment,
               is_kind = to.kind == Kind::time || to.kind == Kind::clock || is_moment ||
                         dialect.dates_count_seconds;
    return dialect.times_count_ms && !e.place.source->is_prelude() && to.is_time() &&
           !to.counts_ns && is_kind &&
           (!from.is_time() || from.counts_ns ||
            (from.kind != to.kind && dialect.dates_count_seconds));
}

/// It begins again at 2^32 ms or s, a TIME of SCL after 2^31 - 1 with the least one.
Slot in_whole_units(Writing& w, Slot slot, const Type& from, const Type& to, const Place& place,
                    Slot wanted) {
    const bool has_sign = place.dialect().times_have_signs;
    const bool is_moment_of_s7 = has_sign && to.kind == Kind::moment;
    const Slot unit = w.constant_slot(is_moment_of_s7 ? of_ms : unit_of(to));
    const bool is_unsigned = from.is_unsigned_64() && from.is_time();
    Slot count = w.emit(is_unsigned ? Op::div_ulint : Op::div_lint, none, slot, unit);
    if (to.kind == Kind::time || !has_sign)
        count = w.emit(of_type(Op::wrap_sint, integer_type(32, has_sign)), none, count);
    if (to.kind == Kind::date) {
        const Slot day = w.constant_slot(of_days / of_seconds);
        count = w.emit(Op::mul_lint, none, w.emit(Op::div_lint, none, count, day), day);
    }
    return w.emit(Op::mul_lint, wanted, count, unit);
}

/// A REAL counts what a number does.
Slot whole_time(Writing& w, const Expression& e, Slot slot, Slot wanted) {
    const Type &from = e.operands[0]->type->plain(), &to = e.type->plain();
    const bool is_real = from.is_real();
    if (is_real) slot = w.emit(Op::round_lint, none, w.emit(Op::round_away, none, slot));
    if (is_real || is_counted(e))
        slot = convert_counted(w, slot, to, unit_of(to), none);
    else
        slot = convert(w, slot, from, to, false, none);
    return in_whole_units(w, slot, from, to, e.place, wanted);
}

/// MatIEC keeps only as many digits as there is room for, and has 0 of what has others than those
/// of numbers.
Slot suited_to_matiec(Writing& w, const Expression& e, Slot from) {
    if (!e.type->is_bits())
        return w.emit(Op::mul_ulint, none, from, w.emit(Op::is_bcd, none, from));
    std::uint64_t beyond = 1;
    for (int digit = 0; digit < e.type->bits / 4; ++digit) beyond *= 10;
    return w.emit(Op::mod_ulint, none, from, w.constant_slot(beyond));
}

Slot convert_bcd(Writing& w, const Expression& e, Slot wanted) {
    Slot from = value(w, *e.operands[0]);
    if (e.place.dialect().functions_are_in_c) from = suited_to_matiec(w, e, from);
    if (e.type->is_bits())
        return w.emit(Op::to_bcd, wanted, from, static_cast<Slot>(e.type->bits / 4));
    return w.emit(of_type(Op::wrap_sint, *e.type), wanted, w.emit(Op::from_bcd, none, from));
}

}  // namespace

bool is_finer_than_ms(const Type* block, const Type& type, const Place& place) {
    return block && block->kind == Kind::standard && type.kind == Kind::time && !type.counts_ns &&
           place.dialect().times_count_ms && !place.source->is_prelude();
}

Slot whole_ms(Writing& w, Slot slot, const Place& place, Slot wanted) {
    return in_whole_units(w, slot, time_type, time_type, place, wanted);
}

Slot attempted(Writing& w, const Expression& e, Slot wanted) {
    const Expression& given = *e.operands[0];
    const Slot from =
        given.type->is_reference()            ? reference(w, given)
        : given.type->kind == Kind::interface ? value(w, given)
                                              : w.emit(Op::lasting, none,
                                                       address_of(w, locate(w, given)));
    const Type& block = e.type->is_reference() ? *e.type->element : *e.type;
    return w.emit(Op::attempt, wanted, from, method_number(w, *block.routine));
}

/// The value has not been kept in a type of its own.
Slot convert_wide(Writing& w, Slot slot, const Type& to, Slot wanted) {
    if (to.is_real()) return convert(w, slot, lint_type, to, false, wanted);
    return to.bits == 64 ? slot : w.emit(of_type(Op::wrap_sint, to.plain()), wanted, slot);
}

static Slot s7_integer_of(Writing& w, Slot text, const Type& type, Slot wanted) {
    const Slot to = w.result(wanted);
    w.put(Op::s7_integer_of_text, to, text, static_cast<Slot>(type.bits), type.is_signed);
    return to;
}

/// As MatIEC's C library has it: of a time seconds.
static Slot matiec_number_of_text(Writing& w, Slot text, const Type& type, Slot wanted) {
    if (type.is_real()) {
        const Slot real = w.emit(Op::matiec_real_of_text, none, text);
        return type.bits == 32 ? w.emit(Op::narrow, wanted, real) : real;
    }
    const Slot whole = w.emit(Op::matiec_integer_of_text, none, text, type.is_time());
    if (type.is_time()) return convert_counted(w, whole, type, of_seconds, wanted);
    return w.emit(of_type(Op::wrap_sint, type), wanted, whole);
}

static Slot of_text(Writing& w, const Expression& e, Slot text, Slot wanted) {
    const Dialect& dialect = e.place.dialect();
    const Slot groups = dialect.number_of_text == NumberOfText::grouped_digits ? 1 : 0;
    const bool is_s7 =
        dialect.number_of_text == NumberOfText::of_s7 && !e.place.source->is_prelude();
    if (is_s7 && is_whole_number(*e.type)) return s7_integer_of(w, text, *e.type, wanted);
    if (e.type->kind == Kind::boolean)
        return w.emit(Op::truth_of_text, wanted, text, dialect.truth_may_go_on);
    if (e.type->is_character) {
        const Slot to = w.result(wanted);
        w.put(Op::text_character, to, text, w.constant_slot(1),
              TextRoom(1, e.type->bits == 16).number());
        return to;
    }
    if (dialect.number_of_text == NumberOfText::of_matiec)
        return matiec_number_of_text(w, text, e.type->plain(), wanted);
    if (e.type->kind == Kind::real) {
        const Slot real = is_s7 ? w.emit(Op::s7_real_of_text, none, text)
                                : w.emit(Op::real_of_text, none, text, groups);
        return e.type->bits == 32 ? w.emit(Op::narrow, wanted, real) : real;
    }
    if (e.type->is_time()) {
        const Slot time = w.emit(Op::time_of_text, none, text, static_cast<Slot>(e.type->kind));
        return is_whole(e) ? in_whole_units(w, time, time_type, *e.type, e.place, wanted) : time;
    }
    return w.emit(of_type(Op::wrap_sint, e.type->plain()), wanted,
                  w.emit(Op::integer_of_text, none, text, groups));
}

Slot converted(Writing& w, const Expression& e, Slot wanted) {
    const Expression& operand = *e.operands[0];
    if (e.type->kind == Kind::handle)
        return w.emit(Op::set_global_number, wanted, static_cast<Slot>(operand.variable->global));
    if (e.conversion.is_attempt) return attempted(w, e, wanted);
    if (e.type->kind == Kind::interface) {
        if (operand.type->kind == Kind::interface) return value(w, operand, wanted);
        return w.emit(Op::lasting, wanted, address_of(w, locate(w, operand)));
    }
    if (operand.type->is_reference())
        return convert(w, address_number(w, operand), lint_type, *e.type, false, wanted);
    if (operand.type->kind == Kind::text) return of_text(w, e, text_address(w, operand), wanted);
    if (e.conversion.is_bcd) return convert_bcd(w, e, wanted);
    if (!e.conversion.is_written && is_wide(w, operand) &&
        (e.type->is_number() || e.type->is_bits()))
        return convert_wide(w, wide_value(w, operand), *e.type, wanted);
    if (is_whole(e)) return whole_time(w, e, value(w, operand), wanted);
    const Type &given = operand.type->plain(), &to = e.type->plain();
    if (is_of_matiec(e)) return convert_seconds(w, value(w, operand), given, to, wanted);
    if (is_cut_by_matiec(e)) return cut_by_matiec(w, value(w, operand), to, wanted);
    const bool in_days = counts_days(e);
    if (in_days || is_counted(e))
        return convert_counted(w, value(w, operand), to,
                               in_days ? of_days : unit_of(given.is_time() ? given : to), wanted);
    Slot from = value(w, operand);
    const bool is_lowest_bit =
        e.place.dialect().truth_is_lowest_bit && !e.place.source->is_prelude();
    if (e.type->kind == Kind::boolean && is_lowest_bit && is_whole_number(*operand.type))
        return w.emit(Op::and_bits, wanted, from, w.constant_slot(1));
    if (e.conversion.rounds_away) from = w.emit(Op::round_away, none, from);
    return convert(w, from, *operand.type, *e.type, e.conversion.truncates, wanted);
}

/// What the numbers mean that become values of an enumeration. A catalogue's has the values of a
/// source's in their order.
Slot look_up_value(Writing& w, Slot slot, const Type& from, const Type& to) {
    if (from.kind == Kind::enumeration && !to.has_numbers)
        return from.counted ? slot : look_up_place(w, slot, from.numbers);
    if (!from.is_integer() || to.of_number.empty()) return slot;
    if (to.all_others_as_last)
        slot = w.emit(Op::min_unsigned, none, slot, w.constant_slot(to.of_number.size() - 1));
    return look_up(w, slot, to.of_number);
}

/// To an enumeration. One that is checked takes its own numbers alone.
Slot convert_to_value(Writing& w, Slot slot, const Type& from, const Type& to, bool truncates) {
    if (from.is_real()) slot = convert_real(w, slot, from, lint_type, truncates, none);
    if (to.is_unchecked)
        return convert(w, slot, from.is_real() ? lint_type : from, *to.base, truncates, none);
    slot = look_up_value(w, slot, from, to);
    const bool has_gaps = to.has_numbers && !to.counted;
    const Slot place = has_gaps ? look_up_place(w, slot, to.numbers) : slot;
    w.put(Op::within, 0, place, w.table({0, to.values.size(), 1}));
    return slot;
}

Slot convert(Writing& w, Slot slot, const Type& given_from, const Type& given_to, bool truncates,
             Slot wanted) {
    const Type &from = given_from.plain(), &to = given_to.plain();
    if (given_to.in_a_run().is_subrange)
        return within(w, given_to, convert(w, slot, from, to, truncates, none));
    if (&from == &to || (from.kind == Kind::boolean && to.kind == Kind::boolean)) return slot;
    if (to.kind == Kind::enumeration) return convert_to_value(w, slot, from, to, truncates);
    if (from.kind == Kind::enumeration && (!from.counted || from.is_unchecked))
        return convert(w, slot, *from.base, to, truncates, wanted);
    if (from.is_time() && to.is_time()) return convert_date(w, slot, from, to, wanted);
    if (from.is_time() || to.is_time()) return convert_time(w, slot, from, to, wanted);
    if (from.is_real() || to.is_real()) return convert_real(w, slot, from, to, truncates, wanted);
    if (to.kind == Kind::boolean) return w.emit(Op::ne_word, wanted, slot, w.constant_slot(0));
    if (widens(from, to) || from.kind == Kind::boolean || from.kind == Kind::enumeration)
        return slot;
    return w.emit(of_type(Op::wrap_sint, to), wanted, slot);
}

}  // namespace lineshaft::st

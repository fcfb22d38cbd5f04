#include <algorithm>
#include <optional>

#include "runtime/st/code/meaning.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/values.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st {

namespace {

constexpr std::uint32_t result_slots = 1 + (longest_result_of_codesys + 7) / 8,
                        wide_result_slots = 1 + (3 * longest_result_of_codesys + 7) / 8;

Slot constant_text(Writing& w, std::string_view text) {
    const auto first = static_cast<std::uint32_t>(w.constants.size());
    std::vector<std::uint64_t> words(1 + (text.size() + 7) / 8);
    words[0] = text.size();
    std::ranges::copy(text, reinterpret_cast<char*>(words.data() + 1));
    w.constants.insert(w.constants.end(), words.begin(), words.end());
    return w.emit(Op::set_address, none, Region::constant + first);
}

meaning::RealForm form_of_reals(const Dialect& dialect) {
    using enum meaning::RealForm;
    switch (dialect.text_of_real) {
        case TextOfReal::shortest:
            return shortest;
        case TextOfReal::rounded:
            return rounded;
        case TextOfReal::of_codesys:
            return of_codesys;
        case TextOfReal::with_exponent:
            return exponent;
    }
    return shortest;
}

TimeForm form_of_time(const Type& type, const Dialect& dialect) {
    return type.counts_ns ? dialect.text_of_long_time : dialect.text_of_time;
}

/// The name of the value goes to the text, which stays where the number is that of none.
void write_name(Writing& w, const Type& type, Slot number, Slot text) {
    Jumps end;
    for (std::size_t i = 0; i < type.values.size(); ++i) {
        Jumps next;
        const Slot kept = w.constant_slot(static_cast<std::uint64_t>(type.numbers[i]));
        w.jump(Op::jump_unless, 0, w.emit(Op::eq_word, none, number, kept), next);
        w.put(Op::text_copy, text, constant_text(w, type.values[i]),
              w.constant_slot(type.values[i].size()));
        w.jump(Op::jump, 0, 0, end);
        w.land(next);
    }
    w.land(end);
}

/// T#0s is 'T#0ms' in CODESYS and TwinCAT.
void write_no_time(Writing& w, Slot number, Slot text) {
    Jumps end;
    w.jump(Op::jump_if, 0, number, end);
    constexpr std::string_view none_at_all = "T#0ms";
    w.put(Op::text_copy, text, constant_text(w, none_at_all), w.constant_slot(none_at_all.size()));
    w.land(end);
}

/// As MatIEC writes a number; none: it writes it as all others do.
std::optional<Op> text_op_of_matiec(const Type& from) {
    if (from.is_bits() && from.kind != Kind::boolean) return Op::text_of_bits;
    if (from.is_real()) return Op::text_of_ten_digits;
    if (from.kind == Kind::time) return Op::text_of_parts;
    return {};
}

/// The characters of one are units, those of the other bytes.
bool is_recoded(const Expression& e) {
    const Type& from = *e.operands[0]->type;
    return e.kind == E::converted && from.kind == Type::Kind::text &&
           from.is_wide != e.type->is_wide && e.place.dialect().texts_are_windows_1252;
}

Slot recoded_text(Writing& w, const Expression& e) {
    const Type& from = *e.operands[0]->type;
    const std::uint32_t length =
        from.is_open ? static_cast<std::uint32_t>(longest_result_of_codesys) : from.length;
    const std::uint32_t bytes = e.type->is_wide ? 3 * length : length;
    const Slot given = text_address(w, *e.operands[0]),
               made = w.emit(Op::set_address, none, w.new_temporary(1 + (bytes + 7) / 8));
    w.put(Op::text_recode, made, given, TextRoom(length, e.type->is_wide).number());
    return made;
}

Slot text_conversion(Writing& w, const Expression& e) {
    const Expression& from = *e.operands[0];
    if (is_recoded(e)) return recoded_text(w, e);
    if (from.type->kind == Type::Kind::text) return text_address(w, from);
    Slot number = value(w, from);
    const Slot kept = number;
    if (from.type->kind == Type::Kind::enumeration)
        number = convert(w, number, *from.type, lint_type, false, none);
    const bool is_unit = from.type->is_character && from.type->bits == 16;
    const auto [text, made] = new_text(w, is_unit);
    if (is_unit) {
        w.put(Op::set_text_byte, number, made, w.constant_slot(0),
              w.constant_slot(TextRoom(1, true).number()));
        return made;
    }
    if (from.type->is_character) {
        w.put(comparison_op(Word::unequal, lint_type), text, number, w.constant_slot(0));
        w.put(Op::move, text + 1, number);
        return made;
    }
    if (e.place.dialect().functions_are_in_c)
        if (const auto op = text_op_of_matiec(from.type->plain())) {
            w.put(*op, made, number);
            return made;
        }
    if (from.type->is_time()) {
        const TimeText time{from.type->kind, form_of_time(*from.type, e.place.dialect()),
                            from.type->is_unsigned_64()};
        w.put(Op::text_of_time, made, number, time.number());
        if (from.type->kind == Type::Kind::time && !from.type->counts_ns &&
            e.place.dialect().no_time_is_ms)
            write_no_time(w, number, made);
        return made;
    }
    const Op op = from.type->kind == Type::Kind::boolean ? Op::text_of_truth
                  : from.type->is_real()
                      ? (from.type->bits == 32 ? Op::text_of_float : Op::text_of_real)
                  : from.type->is_unsigned_64() ? Op::text_of_unsigned
                                                : Op::text_of_signed;
    const Slot form = from.type->is_real() ? static_cast<Slot>(form_of_reals(e.place.dialect()))
                                           : e.conversion.has_sign;
    w.put(op, made, number, form);
    if (from.type->texts_are_names) write_name(w, *from.type, kept, made);
    return made;
}

}  // namespace

NewText new_text(Writing& w, bool is_wide) {
    const Slot text = w.new_temporary(is_wide ? wide_result_slots : result_slots);
    w.put(Op::move, text, w.constant_slot(0));
    return {text, w.emit(Op::set_address, none, text)};
}

Slot text_before(Writing& w, const Expression& e, const Expression& later) {
    if (e.kind == E::converted && e.operands[0]->type->kind == Type::Kind::text && !is_recoded(e))
        return text_before(w, *e.operands[0], later);
    const Slot from = text_address(w, e);
    const bool is_variable = e.kind != E::constant && e.kind != E::call && e.kind != E::converted;
    if (!is_variable || e.type->is_open || !has_call(later)) return from;
    const Slot text = w.new_temporary(slots_of(w, *e.type));
    const Slot made = w.emit(Op::set_address, none, text);
    w.put(Op::text_copy, made, from, w.constant_slot(e.type->room().number()));
    return made;
}

Slot text_address(Writing& w, const Expression& e) {
    if (e.kind == E::constant) return constant_text(w, e.constant.text);
    if (e.kind == E::call && e.routine) return w.emit(Op::set_address, none, call(w, e, none));
    if (e.kind == E::call) return standard(w, e, none);
    if (e.kind == E::converted) return text_conversion(w, e);
    const Location at = locate(w, e);
    return at.packed ? load_packed_text(w, at) : address_of(w, at);
}

}  // namespace lineshaft::st

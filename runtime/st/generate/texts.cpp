#include "runtime/st/generate/texts.hpp"

#include <algorithm>

#include "runtime/st/functions/standard.hpp"
#include "runtime/st/generate/calls.hpp"
#include "runtime/st/generate/conversions.hpp"
#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/standard_functions.hpp"
#include "runtime/st/generate/values.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using E = Expression::Kind;

constexpr std::uint32_t result_slots = 1 + (longest_result + 7) / 8;

/// An empty text among the temporaries.
Slot new_text(Writing& w, Slot& address) {
    const Slot text = w.new_temporary(result_slots);
    w.put(Op::move, text, w.constant_slot(0));
    address = w.emit(Op::set_address, none, text);
    return text;
}

/// Characters from the one numbered `first` (from 0) on.
void append(Writing& w, Slot to, Slot from, Slot first, Slot count) {
    const Slot range = w.new_temporary(2);
    w.put(Op::move, range, first);
    w.put(Op::move, range + 1, count);
    w.put(Op::text_append, to, from, range);
}

Slot text_function(Writing& w, const Expression& e) {
    const std::string_view name = e.standard->name;
    const auto text = [&](std::size_t i) { return text_address(w, *e.arguments[i].value); };
    const auto number = [&](std::size_t i) { return value(w, *e.arguments[i].value); };
    const Slot zero = w.constant_slot(0), one = w.constant_slot(1), all = w.constant_slot(1U << 30);
    const auto sum = [&](Slot a, Slot b) { return w.emit(Op::add_lint, none, a, b); };
    const auto difference = [&](Slot a, Slot b) { return w.emit(Op::sub_lint, none, a, b); };
    const Slot in = text(0);
    Slot made = none;
    if (name == "CONCAT") {
        std::vector<Slot> parts{in};
        for (std::size_t i = 1; i < e.arguments.size(); ++i) parts.push_back(text(i));
        new_text(w, made);
        for (const Slot part : parts) append(w, made, part, zero, all);
    } else if (name == "LEFT") {
        const Slot count = number(1);
        new_text(w, made);
        append(w, made, in, zero, count);
    } else if (name == "RIGHT") {
        const Slot count = number(1);
        new_text(w, made);
        append(w, made, in, difference(w.emit(Op::text_length, none, in), count), count);
    } else if (name == "MID") {
        const Slot count = number(1), place = number(2);
        new_text(w, made);
        append(w, made, in, difference(place, one), count);
    } else if (name == "DELETE") {
        const Slot count = number(1), before = difference(number(2), one);
        new_text(w, made);
        append(w, made, in, zero, before);
        append(w, made, in, sum(before, count), all);
    } else {  // INSERT(in1, in2, p), REPLACE(in1, in2, l, p)
        const bool replaces = name == "REPLACE";
        const Slot other = text(1);
        const Slot count = replaces ? number(2) : zero;
        const Slot before = replaces ? difference(number(3), one) : number(2);
        new_text(w, made);
        append(w, made, in, zero, before);
        append(w, made, other, zero, all);
        append(w, made, in, sum(before, count), all);
    }
    return made;
}

Slot text_conversion(Writing& w, const Expression& e) {
    const Expression& from = *e.operands[0];
    Slot number = value(w, from);
    if (from.type->kind == Type::Kind::enumeration)
        number = convert(w, number, *from.type, lint_type, false, none);
    Slot made = none;
    const Slot text = new_text(w, made);
    if (from.type->is_character) {
        w.put(Op::move, text, w.constant_slot(1));
        w.put(Op::move, text + 1, number);
        return made;
    }
    if (from.type->is_time()) {
        w.put(Op::text_of_time, made, number, static_cast<Slot>(from.type->kind));
        return made;
    }
    const Op op = from.type->kind == Type::Kind::boolean ? Op::text_of_truth
                  : from.type->is_real()
                      ? (from.type->bits == 32 ? Op::text_of_float : Op::text_of_real)
                  : from.type->is_unsigned_64() ? Op::text_of_unsigned
                                                : Op::text_of_signed;
    w.put(op, made, number, e.conversion.has_sign ? 1 : 0);
    return made;
}

}  // namespace

Slot text_address(Writing& w, const Expression& e) {
    if (e.kind == E::constant) {
        const auto first = static_cast<std::uint32_t>(w.constants.size());
        const std::string& text = e.constant.text;
        std::vector<std::uint64_t> words(1 + (text.size() + 7) / 8);
        words[0] = text.size();
        std::ranges::copy(text, reinterpret_cast<char*>(words.data() + 1));
        w.constants.insert(w.constants.end(), words.begin(), words.end());
        return w.emit(Op::set_address, none, Region::constant + first);
    }
    if (e.kind == E::call && e.routine) return w.emit(Op::set_address, none, call(w, e, none));
    if (e.kind == E::call) {
        const Rule rule = e.standard->rule;
        return rule == Rule::text ? text_function(w, e) : standard(w, e, none);
    }
    if (e.kind == E::converted) return text_conversion(w, e);
    return address_of(w, locate(w, e));
}

}  // namespace lineshaft::st

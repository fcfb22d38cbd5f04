#include <algorithm>

#include "runtime/st/generate/generator_class.hpp"

namespace lineshaft::st {

namespace {

using E = Expression::Kind;

constexpr std::uint32_t result_slots = 1 + (longest_result + 7) / 8;

}  // namespace

/// An empty text among the temporaries.
Slot Generator::new_text(Slot& address) {
    const Slot text = new_temporary(result_slots);
    put(Op::move, text, constant_slot(0));
    address = emit(Op::set_address, none, text);
    return text;
}

/// A slot with the address of the value, which is a text.
Slot Generator::text_address(const Expression& e) {
    if (e.kind == E::constant) {
        const auto first = static_cast<std::uint32_t>(constants_.size());
        const std::string& text = e.constant.text;
        std::vector<std::uint64_t> words(1 + (text.size() + 7) / 8);
        words[0] = text.size();
        std::ranges::copy(text, reinterpret_cast<char*>(words.data() + 1));
        constants_.insert(constants_.end(), words.begin(), words.end());
        return emit(Op::set_address, none, Region::constant + first);
    }
    if (e.kind == E::call && e.routine) return emit(Op::set_address, none, call(e, none));
    if (e.kind == E::call) {
        const Rule rule = standard_functions()[static_cast<std::size_t>(e.standard)].rule;
        return rule == Rule::text ? text_function(e) : standard(e, none);
    }
    if (e.kind == E::converted) return text_conversion(e);
    return address_of(locate(e));
}

/// Characters from the one numbered `first` (from 0) on.
void Generator::append(Slot to, Slot from, Slot first, Slot count) {
    const Slot range = new_temporary(2);
    put(Op::move, range, first);
    put(Op::move, range + 1, count);
    put(Op::text_append, to, from, range);
}

Slot Generator::text_function(const Expression& e) {
    const std::string_view name = standard_functions()[static_cast<std::size_t>(e.standard)].name;
    const auto text = [&](std::size_t i) { return text_address(*e.arguments[i].value); };
    const auto number = [&](std::size_t i) { return value(*e.arguments[i].value); };
    const Slot zero = constant_slot(0), one = constant_slot(1), all = constant_slot(1U << 30);
    const auto sum = [&](Slot a, Slot b) { return emit(Op::add_lint, none, a, b); };
    const auto difference = [&](Slot a, Slot b) { return emit(Op::sub_lint, none, a, b); };
    const Slot in = text(0);
    Slot made = none;
    if (name == "CONCAT") {
        std::vector<Slot> parts{in};
        for (std::size_t i = 1; i < e.arguments.size(); ++i) parts.push_back(text(i));
        new_text(made);
        for (const Slot part : parts) append(made, part, zero, all);
    } else if (name == "LEFT") {
        const Slot count = number(1);
        new_text(made);
        append(made, in, zero, count);
    } else if (name == "RIGHT") {
        const Slot count = number(1);
        new_text(made);
        append(made, in, difference(emit(Op::text_length, none, in), count), count);
    } else if (name == "MID") {
        const Slot count = number(1), place = number(2);
        new_text(made);
        append(made, in, difference(place, one), count);
    } else if (name == "DELETE") {
        const Slot count = number(1), before = difference(number(2), one);
        new_text(made);
        append(made, in, zero, before);
        append(made, in, sum(before, count), all);
    } else {  // INSERT(in1, in2, p), REPLACE(in1, in2, l, p)
        const bool replaces = name == "REPLACE";
        const Slot other = text(1);
        const Slot count = replaces ? number(2) : zero;
        const Slot before = replaces ? difference(number(3), one) : number(2);
        new_text(made);
        append(made, in, zero, before);
        append(made, other, zero, all);
        append(made, in, sum(before, count), all);
    }
    return made;
}

Slot Generator::text_conversion(const Expression& e) {
    const Expression& from = *e.operands[0];
    Slot number = value(from);
    if (from.type->kind == Type::Kind::enumeration)
        number = convert(number, *from.type, lint_type, false, none);
    Slot made = none;
    const Slot text = new_text(made);
    if (from.type->is_character) {
        put(Op::move, text, constant_slot(1));
        put(Op::move, text + 1, number);
        return made;
    }
    if (from.type->is_time()) {
        put(Op::text_of_time, made, number, static_cast<Slot>(from.type->kind));
        return made;
    }
    const Op op = from.type->kind == Type::Kind::boolean ? Op::text_of_truth
                  : from.type->is_real()
                      ? (from.type->bits == 32 ? Op::text_of_float : Op::text_of_real)
                  : from.type->is_unsigned_64() ? Op::text_of_unsigned
                                                : Op::text_of_signed;
    put(op, made, number, e.op == Word::plus ? 1 : 0);
    return made;
}

}  // namespace lineshaft::st

#include "runtime/st/check/untyped_arguments.hpp"

#include <algorithm>

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

bool are_bits(const Expression& call, std::size_t first) {
    return std::all_of(call.arguments.begin() + static_cast<std::ptrdiff_t>(first),
                       call.arguments.end(), [](const Argument& argument) {
                           const Expression& value = *argument.value;
                           return is_constant(value) && value.type->is_any() &&
                                  !value.type->is_real() &&
                                  (value.constant.integer == 0 || value.constant.integer == 1);
                       });
}

const Type& real_of_literals(const Expression& call, std::size_t first, const Type* expected) {
    const auto begin = call.arguments.begin() + static_cast<std::ptrdiff_t>(first);
    const bool is_of_single =
        std::any_of(begin, call.arguments.end(),
                    [](const Argument& argument) { return is_single(*argument.value->type); });
    const bool is_double = !is_of_single && makes_lreal_of_literals(call.place, expected);
    return is_double ? lreal_type : real_type;
}

const Type& type_of_literals(const Expression& call, std::size_t first, const Type& expected) {
    if (!expected.is_real() || call.place.dialect().literals_suit_their_use) return expected;
    const Type& whole = is_single(expected) ? int_type : dint_type;
    const auto fits = [&](const Argument& argument) {
        const Wide value = argument.value->constant.integer;
        return value >= smallest(whole) && value <= largest(whole);
    };
    const auto begin = call.arguments.begin() + static_cast<std::ptrdiff_t>(first);
    return std::all_of(begin, call.arguments.end(), fits) ? whole : expected;
}

static bool holds_whole(const Type& type) {
    return type.kind == Kind::integer || type.kind == Kind::bits;
}

const Type& type_with_literals(const Expression& call, std::size_t first, const Type& common,
                               const Type* expected) {
    const Type* held = &common;
    for (std::size_t i = first; i < call.arguments.size(); ++i) {
        const Expression& value = *call.arguments[i].value;
        const Type& plain = held->plain();
        if (!holds_whole(plain) || !is_constant(value) || value.type->kind != Kind::any_integer)
            continue;
        const bool counts = plain.kind == Kind::bits && value.constant.integer < 0;
        const Type& typed = counts ? integer_type(plain.bits, false) : plain;
        if (const Type* wider = wider_for(value, typed, expected)) held = wider;
    }
    const bool is_due = expected && holds_whole(expected->plain()) && !widens(*held, *expected);
    return is_due && !call.place.dialect().reckons_in_registers ? common : *held;
}

const Type* take_back(Checking& c, Expression*& e, const Type* type, const Type* expected) {
    if (!type || !expected || !e->place.dialect().reckons_in_registers) return type;
    const Type& due = expected->plain();
    if (!holds_whole(*type) || !holds_whole(due) || widens(*type, due)) return type;
    const bool is_choice = e->standard->typing == Typing::chosen;
    bool is_by_literal = false;
    for (std::size_t i = is_choice ? 1 : 0; i < e->arguments.size(); ++i) {
        const Expression* value = e->arguments[i].value;
        if (is_constant(*value)) {
            const Wide number = value->constant.integer;
            is_by_literal |= number < smallest(due) || number > largest(due);
            continue;
        }
        if (value->kind == E::converted) value = value->operands[0];
        if (!widens(*value->type, due)) return type;
    }
    if (!is_by_literal) return type;
    e->type = type;
    warn_of_loss(c, *e, due);
    return convert_result(c, e, *type, due);
}

}  // namespace lineshaft::st

#include "runtime/st/check/untyped_arguments.hpp"

#include <algorithm>

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/nodes.hpp"

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

}  // namespace lineshaft::st

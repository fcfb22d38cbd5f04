#include "runtime/st/types/types.hpp"

#include <algorithm>

namespace lineshaft::st {

bool is_packed(const Expression& place) {
    if (place.variable && place.variable->space == Space::image) return true;
    return place.operands[0] && is_packed(*place.operands[0]);
}

bool has_call(const Expression& e) {
    if (e.kind == Expression::Kind::call && e.routine) return true;
    for (const Expression* operand : e.operands)
        if (operand && has_call(*operand)) return true;
    return std::ranges::any_of(e.arguments, [](const Argument& a) { return has_call(*a.value); });
}

}  // namespace lineshaft::st

#include "runtime/st/types/types.hpp"

#include <algorithm>

namespace lineshaft::st {

bool has_call(const Expression& e) {
    if (e.kind == Expression::Kind::call && e.routine) return true;
    for (const Expression* operand : e.operands)
        if (operand && has_call(*operand)) return true;
    return std::ranges::any_of(e.arguments, [](const Argument& a) { return has_call(*a.value); });
}

std::vector<Variable*> all_variables(const Routine& block) {
    std::vector<Variable*> all;
    if (block.base) all = all_variables(*block.base);
    for (const Variable& variable : block.variables)
        all.push_back(const_cast<Variable*>(&variable));
    return all;
}

bool is_a(const Routine& block, const Routine& other) {
    if (&block == &other || (block.base && is_a(*block.base, other))) return true;
    return std::ranges::any_of(block.interfaces,
                               [&](const Routine* base) { return is_a(*base, other); });
}

}  // namespace lineshaft::st

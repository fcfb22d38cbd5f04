#include "runtime/source/letters.hpp"
#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/types.hpp"

namespace lineshaft::st {

const Type* timer_of(Checking& c, const Type& type, const Token& called) {
    const bool is_any = same_name(type.name, "IEC_TIMER") || same_name(type.name, "IEC_LTIMER");
    const bool is_timer = same_name(called.text, "TOF") || same_name(called.text, "TP");
    return is_any && is_timer ? standard_type(c, called.text) : nullptr;
}

const Variable* variable_of_instance(const Expression& instance) {
    const Expression* at = &instance;
    while (at->kind == E::index) at = at->operands[0];
    return at->variable;
}

void note_timer(Checking& c, const Expression& timer, const BlockType& called) {
    const Variable* variable = variable_of_instance(timer);
    if (!variable) return;
    const auto [it, is_new] = c.checked.called_as.emplace(variable, &called);
    if (!is_new && it->second != &called) it->second = nullptr;
}

}  // namespace lineshaft::st

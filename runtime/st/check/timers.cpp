#include "runtime/source/letters.hpp"
#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/types.hpp"

namespace lineshaft::st {

namespace {

bool is_any_timer(std::string_view type) {
    return same_name(type, "IEC_TIMER") || same_name(type, "IEC_LTIMER");
}

/// `sum` of `"Data".sum.TONR(...)` and of `sum[3].TONR(...)`.
std::string_view name_of_instance(const Expression& call) {
    const Expression* at = call.operands[0]->operands[0];
    while (at->kind == E::index) at = at->operands[0];
    return at->token.text;
}

/// Names of what is called as a TONR and as no other timer.
NameSet names_of_sums(const Checking& c) {
    NameSet sums, others;
    for (const Expression& e : c.tree.expressions) {
        const bool is_call = e.kind == E::call && e.operands[0]->kind == E::member &&
                             e.place.source && e.place.dialect().has_s7_instructions;
        if (!is_call) continue;
        const std::string_view called = e.operands[0]->token.text;
        if (same_name(called, "TONR")) sums.insert(name_of_instance(e));
        for (const std::string_view other : {"TON", "TOF", "TP"})
            if (same_name(called, other)) others.insert(name_of_instance(e));
    }
    std::erase_if(sums, [&](std::string_view name) { return others.contains(name); });
    return sums;
}

}  // namespace

void make_sums_of_timers(Checking& c) {
    const NameSet sums = names_of_sums(c);
    if (sums.empty()) return;
    const auto become_sum = [&](std::string_view name, TypeText*& type) {
        if (!type || !is_any_timer(type->name.text) || !sums.contains(name)) return;
        type = &c.tree.type_texts.emplace_back(*type);
        type->name.text = "TONR";
    };
    for (Declaration& declared : c.tree.declarations) become_sum(declared.name.text, declared.type);
    for (Pou* unit : c.tree.units) become_sum(unit->name.text, unit->base);
}

bool is_named_as_its_kind(const Type& type, std::string_view name) {
    if (type.kind == Kind::standard) return same_name(type.standard->name, name);
    return type.kind == Kind::block && is_prelude(type.routine->pou->name) &&
           same_name(type.routine->pou->name.text, name);
}

const Type* timer_of(Checking& c, const Type& type, const Token& called) {
    const bool is_timer = same_name(called.text, "TOF") || same_name(called.text, "TP");
    return is_any_timer(type.name) && is_timer ? standard_type(c, called.text) : nullptr;
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
